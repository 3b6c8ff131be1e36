// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Latches that give, a spring and damper each on a linear form s(q) = sum_i c_i . x_i + offset (Force::form),
// or, where the deployment is told by a measure, on what is left of that: with N = k s + c s',
//
//     F = -N ds/dq,     V = k/2 s^2,     dissipated power = c s'^2
//
// An inertia I that arrives at the rate w is met with the peak N = w sqrt(I k) where c = 0. A latch waits
// for the deployed pose (simulate/latch.hpp): until then it has no form, or is slack.
std::unique_ptr<ForceBlock> latch_spring_block(const Structure& structure, const SparseRows& node_mass);

const std::vector<ParamSpec>& latch_spring_params();
void fill_latch_spring(const ParamSet& values, Force& force);

// It has not closed yet.
bool latch_waits(const Force& force);

// The largest |N| of a structure's latches at node coordinates and velocities: [N], or [N m] where they hold
// an angle or the sine of one; 0 of those that wait.
double latch_load(const Structure& structure, const Moment& at, const VectorXd& q, const VectorXd& v);

}  // namespace unfurl
