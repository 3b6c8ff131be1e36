// SPDX-License-Identifier: BSD-3-Clause
// Which rod bears the largest force of a motion, and when, within steps too.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/diagnostics/force_uniqueness.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_strength.hpp"

namespace unfurl {

// As peak_rod_force() and worst_rod() of the states, but of the motion: where the peak lies within a step,
// the rod that bears most there. Its force is then unique where it is at both ends of the step.
PeakForce peak_rod_force(const Simulation& run, const Diagnostics& diagnostics, Pull pull = Pull::either);
// The states at which single rods have humps that may top all others of a column, which is the largest (sign:
// 1) or least (-1) of what rods bear, the highest first, a few: where another rod bears nearly as much all
// the time, that column does not show them. None of other columns.
std::vector<std::size_t> rod_humps(const Trajectory& run, const Diagnostics& diagnostics,
                                   std::string_view column, double sign);
// `quantity`: axial_stress, stress_ratio or buckling_ratio.
WorstRod worst_rod(const Simulation& run, const Diagnostics& diagnostics,
                   double (*quantity)(const Rod&, double force));

}  // namespace unfurl
