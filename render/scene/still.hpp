// SPDX-License-Identifier: BSD-3-Clause
// Finished pictures of a run: of a film, or one by itself.
#pragma once

#include <functional>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"
#include "render/gl/context.hpp"
#include "render/image/image.hpp"

namespace unfurl {

// The scene with a picture of the motion's shape where it asks for that (render.fit), of as many pixels.
Scene fitted(const Scene& scene, const Simulation& run);

// Do the pictures have transparent pixels: because the scene says so, or its look?
bool has_alpha(const RenderOptions& options);
// For films that have none: before a white wall, or before the look's own ground where that is dark and its
// texts are pale.
Image without_alpha(const Image& image, const RenderOptions& options);

// As a film shows this time [s] of the run, of the size that the scene says. `between`: called between pieces
// of the work, which ends with what it throws.
Image still(const Scene& scene, const Simulation& run, const Diagnostics& diagnostics, double t,
            GlContext& context, const std::function<void()>& between = {});

}  // namespace unfurl
