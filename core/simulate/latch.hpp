// SPDX-License-Identifier: BSD-3-Clause
// Locking a structure in its deployed pose.
#pragma once

#include <memory>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The model with the latches of its deployment held at zero (structure.hpp); where it names none, the sine of
// what is left to its deployed fold angle. A structure with forces of the kind "latch" gets each of them on
// every latch instead: nothing is held then, and no impulse is needed.
LinearForm remaining_form(const Deployment& deployment);  // Deployment::remaining_sine
bool latch_gives(const Structure& structure);             // it has such forces, which wait
std::shared_ptr<const Model> latched_model(const Model& model, bool eliminate_linear);

// A state in the solved coordinates of another system of the same nodes, whose constraints it fulfils.
State in_coordinates(const System& from, const State& state, const System& to);

// A state after the constraints have become those of another model of the same nodes: node positions stay,
// the constraints' impulse takes the part of the velocities that they forbid and nothing else,
//
//     M (w+ - w-) + G^T mu = 0,   G w+ = g'(t)
//
// What is lost is the kinetic energy of w+ - w- (Carnot); drives do the rest of the work.
struct Handover {
  State state;
  double energy_lost = 0.0;  // [J]
};
Handover hand_over(const Model& from, const State& state, const Model& to);

}  // namespace unfurl
