// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Latches that give, a spring and damper each on a linear form s(q) = sum_i c_i . x_i + offset (Force::form):
// with N = k s + c s',
//
//     F = -N ds/dq,     V = k/2 s^2,     dissipated power = c s'^2
//
// An inertia I that arrives at the rate w is met with the peak N = w sqrt(I k) where c = 0. A latch without a
// form is open: it waits for the deployed pose (simulate/latch.hpp).
std::unique_ptr<ForceBlock> latch_spring_block(const Structure& structure, const SparseRows& node_mass);

const std::vector<ParamSpec>& latch_spring_params();
void fill_latch_spring(const ParamSet& values, Force& force);

// N of a latch at node coordinates and velocities: [N], or [N m] where the form is an angle's sine; 0
// of an open one.
double latch_load(const Force& latch, const ConstVec& q, const ConstVec& v);

}  // namespace unfurl
