// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Moments of a run in whose poses all of its motion is to be seen.
struct PosedMoments {
  std::vector<double> times;    // ascending [s]
  std::vector<VectorXd> poses;  // all copied nodes at each [3 N]
};

// All states, and in a step in which a node leaves the straight line between two of them by more than a
// thousandth of the structure's size as many moments as bring it back to that; no more of them than a picture
// can wait for, those where they matter most. Steps that lead straight cost nothing; where the states at
// their ends do not tell, as from rest to rest, one moment.
PosedMoments posed_moments(const Trajectory& run);

// The poses that lie at equal steps of the way that all nodes go together, from the first one on; the last
// one is not among them. Fewer than `count` where there are not as many apart.
std::vector<std::size_t> equal_steps(const std::vector<VectorXd>& poses, std::size_t count);

// Times [s] of `count` poses that tell a motion: its start, its end, and equal steps of the way between.
std::vector<double> pose_times(const Trajectory& run, std::size_t count);

}  // namespace unfurl
