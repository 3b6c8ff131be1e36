// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/integrators/index1.hpp"
#include "core/simulate/deployed_event.hpp"
#include "core/simulate/free_motion.hpp"

namespace unfurl {

// What swings beside a pose to which drives lead, or hangs from it, may be faster than what leads there: then
// no polynomial in time says its forces in the pose, nor those of what it shakes. But its own equations keep
// their rank there, and say them; and what is led is as slow as its drives. So the multipliers of samples
// next to the pose become those that they would have if what is free were felt as in the state `at` of the
// pose: their limit is the same, and they are as smooth as what is led. `acceleration`: of that, in the pose.
void feel_as_at(System& system, FreeMotion& free, Index1& index1, const State& at, VectorXd acceleration,
                std::vector<NearDeployed>& samples);

}  // namespace unfurl
