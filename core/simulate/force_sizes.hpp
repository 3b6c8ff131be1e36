// SPDX-License-Identifier: BSD-3-Clause
// How large what cancels is: of a sum rounding leaves a share of its largest term, whatever its units.
#pragma once

#include "core/structure/structure.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Of each row of the momentum equations in a state with these multipliers, of all its terms one by one [N]:
// weight, loads, other forces as they add up on a coordinate with what rounding coordinates and rates changes
// in them (over round-off), constraint forces. The system must follow the state.
VectorXd force_sizes(const System& system, const Structure& structure, const State& state,
                     const VectorXd& lambda);

// What forces of these sizes give to coordinates each by itself, in the mass metric [m kg^1/2 / s^2].
double free_acceleration(const System& system, const Structure& structure, const State& state,
                         const VectorXd& lambda);

}  // namespace unfurl
