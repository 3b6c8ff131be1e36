// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Nodes that drives hold which have come to rest, in a pose whose constraints alone do not hold them: they
// have lost rank there.
struct HeldNodes {
  std::vector<int> nodes;
  VectorXd places;                       // x, y and z of each
  std::size_t by_base = 0, latched = 0;  // so many of them by the base, and before a latch has closed
};

// 1 of the solved coordinates that nothing joins to a prescribed motion which is not at rest at the time t.
VectorXd resting_coordinates(const System& system, double t, double h);
// Does anything of those that are 1 of `resting` still move at the time t? Others rest as stops, friction or
// other drives have held them since before.
bool comes_to_rest(const System& system, const VectorXd& resting, double t, double h);

// The nodes that only those solved coordinates move which are 1 of `resting`, where nothing that is
// prescribed of these changes behind the time t, in steps of h.
std::vector<int> nodes_at_rest(const Model& model, const VectorXd& resting, double t, double h);

// The model with some of the nodes held in their places.
std::shared_ptr<const Model> model_with_held(const Model& model, const HeldNodes& held, std::size_t first,
                                             std::size_t end, bool eliminate_linear);

}  // namespace unfurl
