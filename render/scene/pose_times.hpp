// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The states that lie at equal steps of the way that all nodes go together, from the first one on; the last
// state is not among them. Fewer than `count` where the run has not as many states apart.
std::vector<std::size_t> equal_steps(const Trajectory& run, std::size_t count);

// Times [s] of `count` poses that tell a motion: its start, its end, and equal steps of the way between.
std::vector<double> pose_times(const Trajectory& run, std::size_t count);

}  // namespace unfurl
