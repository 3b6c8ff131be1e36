// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/frame_builder.hpp"

namespace unfurl {

// What the scene says about its pictures, for a FrameBuilder. Points to run and diagnostics. Throws
// SceneError where a name in it is none of this run's.
FrameStyle film_style(const Scene& scene, const Simulation& run, const Diagnostics& diagnostics);

// Throws SceneError where a name that needs no run to be looked up is none of this structure's.
void check_film_names(const Scene& scene, const Structure& structure);

// The scene's surfaces that are shown, with their nodes. Throws SceneError.
std::vector<ShownSurface> shown_surfaces(const Scene& scene, const Structure& structure);

}  // namespace unfurl
