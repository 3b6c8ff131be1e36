// SPDX-License-Identifier: BSD-3-Clause
// Forces that a controller sets between steps.
#pragma once

#include <memory>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The model with this force [N] on a node, as one more of its loads behind the `own` ones of the scene, in
// place of what was pushed there before; null where that is the same already. Throws std::out_of_range on a
// node that is not solved.
std::shared_ptr<const Model> pushed_model(const Model& model, std::size_t own, int node, const Vec3& force);

}  // namespace unfurl
