// SPDX-License-Identifier: BSD-3-Clause
// From a checked Scene to the Model that the time loop runs.
#pragma once

#include <memory>

#include "core/scene/scene.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The scene's structure with its gravity and loads. Throws SceneError, located at the key at fault, where
// parameters that are each fine cannot make a structure, a load names no node, or a sector model cannot carry
// the load.
Structure build_structure(const Scene& scene);

std::shared_ptr<const Model> build_model(const Scene& scene);

}  // namespace unfurl
