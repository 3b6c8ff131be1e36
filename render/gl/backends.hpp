// SPDX-License-Identifier: BSD-3-Clause
// What make_offscreen_context (context.hpp) chooses from.
#pragma once

#include "render/gl/context.hpp"

namespace unfurl {

// Each throws GraphicsError with the cause where it cannot be had.
std::unique_ptr<GlContext> make_osmesa_context();
std::unique_ptr<GlContext> make_egl_context(bool hardware);

}  // namespace unfurl
