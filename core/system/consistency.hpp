// SPDX-License-Identifier: BSD-3-Clause
// Scenes that no motion can fulfil, found before the first step.
#pragma once

#include <string>
#include <vector>

#include "core/structure/structure.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// At t = 0, in the structure's pose. Throws StructureError that names the members where
//   - constraints are violated: node positions contradict them, or they contradict each other
//   - a drive moves what other constraints hold
//   - nothing can move and nothing is driven
// The last two need the rank of the constraints and are left out for structures of more than 900 coordinates.
void check_consistency(const Structure& structure, const System& system);

// What is driven or warms at a time, by name, where no velocities at the pose q give it the rates it asks
// for: it moves what is held, or one of them against the other. Empty where there are such velocities, and
// for structures of more than 900 coordinates.
std::string driven_against(const System& system, double t, const VectorXd& q);

// "a, b and 3 more": so many names at most.
std::string listed(const std::vector<std::string>& names, std::size_t most = 6);

}  // namespace unfurl
