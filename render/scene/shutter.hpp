// SPDX-License-Identifier: BSD-3-Clause
// A picture as a lens and a shutter take it.
#pragma once

#include <functional>

#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"

namespace unfurl {

// The mean of pictures at moments while the shutter is open (shot.open) and from places of a lens as wide as
// depth_of_field times its distance, all looking at the same point; one picture where neither is asked for.
// What is written stays sharp. `between`: called before each of them; what it throws ends the work.
Image exposed(Renderer& renderer, const FrameBuilder& builder, const Shot& shot, double depth_of_field,
              const std::function<void()>& between = {});

}  // namespace unfurl
