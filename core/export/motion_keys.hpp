// SPDX-License-Identifier: BSD-3-Clause
// Moments of a run between which a straight line from pose to pose is its motion, for files that others play.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

struct MotionKeys {
  std::vector<double> times;    // ascending, the run's start and end among them
  std::vector<VectorXd> poses;  // all copied nodes at each [3 N]
  double off = 0;               // what the lines are off by at most, of what they may be
};

// At most `interval` apart, about 200 of them at least where the run has as many states, and closer where the
// straight lines would leave the motion by more than a thousandth of the structure's size or shorten a rod by
// more than a hundredth of its length: a rod that turns far between two keys would be drawn short, or turning
// backwards. No more than `most`, those where they matter most. `between`: called now and then, may throw.
MotionKeys motion_keys(const Trajectory& run, double interval, std::size_t most,
                       const std::function<void()>& between = {});

// Of each column of values at the states [states x columns], at any time: along straight lines; up to a state
// at which it is not known, and from there on, it is what is known next to it.
VectorXd values_at(const Trajectory& run, const MatrixXd& values, double t);

// Keys at states, where straight lines between the keys would leave values at the states by more than
// `bearable`: those where they do so most, until there are `most` keys. Returns what they are off by at most.
double add_value_keys(const Trajectory& run, const MatrixXd& values, double bearable, std::size_t most,
                      MotionKeys& keys);

// What a file says whose keys are too few; empty where they are enough.
std::string too_few_keys(const MotionKeys& keys, std::string_view file);

}  // namespace unfurl
