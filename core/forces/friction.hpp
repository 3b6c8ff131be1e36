// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Dry friction on a measure s(q) (core/structure/measure.hpp), a torque where s is an angle:
//
//     it slips, slip = sgn s':   F = -slip tau_k ds/dq,   W = slip tau_k s has been taken, dW/dt = tau_k |s'|
//     it sticks, slip = 0:       nothing here; s is held as a constraint that gives up to tau_s
//
// Of a hinge with the arm mu r, tau = tau_0 + mu r |F| with the force F of its pin (pin_loads.hpp); what it
// takes is then no function of the pose, but the integral of its power.
//
// OneSided (core/simulate/one_sided.hpp) says which and when.
std::unique_ptr<ForceBlock> friction_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& friction_params();
void fill_friction(const ParamSet& values, Force& force);

}  // namespace unfurl
