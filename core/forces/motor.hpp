// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>

#include "core/forces/force.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

// A motor that turns a measure s through a gear of ratio n. With the motor's speed w = n s' its torque T is
//
//     none        T = T_0 (u(t) - w / w_0)                       u: the share of the full voltage
//     position    n T = k_p e + k_i int e dt + k_d e',           e = f(t) - s
//     rate        n T = k_p e' + k_i e                           (a controller of s' that follows f')
//
// where what a controller asks for is cut to what full voltage gives, T_0 (-1 - w / w_0) <= T <= T_0 (1 -
// w / w_0); all of it is cut to the current's limit. Then F = n T ds/dq. The law is continuous and bends
// where it is cut: each of its parts is smooth, and OneSided (core/simulate/one_sided.hpp) says which one
// holds.
//   The rotor's inertia J is that of a ghost node of mass n^2 J (per m^2) whose coordinate x is tied to s by
// the row s - x = s(0). The integral of the error is the coordinate z of another with the mass m on which the
// motor acts with m e': m z'' = m e' and z'(0) = e(0) give z' = e exactly, whatever m.
struct MotorState {
  double value = 0, rate = 0;                         // s, s'
  double effort = 0;                                  // n T, along s [N m] or [N]
  double by_value = 0, by_rate = 0, by_integral = 0;  // its derivatives
};
MotorState motor_state(const Force& motor, const MeasureFunction& measure, int followed, const Moment& at,
                       const double* q, const double* v, double* gradient);

// By how much a motor's torque may change before each part of its law, in the order of Motor::Regime, gives
// way to another, in units of what counts as zero; the one that holds has the largest room, 0 or more.
using MotorRooms = std::array<double, 5>;
MotorRooms motor_rooms(const Force& motor, const MeasureFunction& measure, int followed, const Moment& at,
                       const double* q, const double* v, double* gradient);
bool bends(const Motor& motor);  // has it more than one part?

std::unique_ptr<ForceBlock> motor_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& motor_params();
void fill_motor(const ParamSet& values, Force& force);
// A drum that draws in a cable: the same parameters with the drum's, the measure being what it has drawn in.
const std::vector<ParamSpec>& winch_params();

// The ghosts of a motor that the structure already has as its last force, with rows and start.
void add_rotor(Structure& structure, double inertia, double initial);
void add_integrator(Structure& structure, double initial);
// A ghost of a mass that moves along x; its node.
int add_ghost(Structure& structure, const std::string& name, double mass, double rate);

}  // namespace unfurl
