// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// A spring and damper on a measure s(q) (core/structure/measure.hpp): with N = k (s - s_0) + c (s' - s_0'),
//
//     F = -N ds/dq,     V = k/2 (s - s_0)^2,     dissipated power = c (s' - s_0')^2
//
// One-sided (a cable): nothing where s <= s_0, and N = max(0, N) where s > s_0, so that it never pushes.
// A cable: k = E A / L with the unstressed length L(t) = s_0, which a winch may change; V depends on t then,
// and its winch puts in k' V / k - N s_0'. With the half width w it begins to pull by a smoothed law instead,
// for nets of many: of the stretch e = s - s_0
//
//     N_e = k (e + w)^2 / (4 w),   V = k (e + w)^3 / (12 w)     |e| <= w
//     N_e = k e,                   V = k (e^2 / 2 + w^2 / 6)    e >= w
//
//   spring           axial, between two nodes: s is their distance
//   torsion_spring   between two rods: s is their angle, N the torque about the hinge
//   cable            over nodes in order: s is the length of its path
//   combination      s is a sum of measures with coefficients
// `followed`: of each spring, the index of its angle among those that count turns; empty: none does.
std::unique_ptr<ForceBlock> spring_block(const std::vector<Force>& springs, const Deployment& deployment,
                                         const std::vector<int>& followed = {});
// k and s_0 at a time, and their rates; of a cable on a drum at the node coordinates q. Its measure is the
// path and x, what the drum has drawn in: unstressed it is L = s_0 - x, so that
//
//     k = E A / L,     V = k/2 (s - s_0)^2,     F_x = -N - k' / 2 (s - s_0)^2,     k' = dk/dx = E A / L^2
struct SpringLaw {
  double stiffness, rest, stiffness_rate, rest_rate;
  int drum = -1;           // coordinate x; -1: there is no drum
  double by_drum = 0;      // k'
  double by_drum_too = 0;  // k''
};
SpringLaw spring_law(const Force& force, double t, const double* q);

// N of a spring at its measure's value and s' - s_0', and the power that what changes its length puts in.
struct SpringPull {
  double tension, reeling;
};
SpringPull spring_pull(const Force& force, const SpringLaw& law, double s, double stretching);

std::unique_ptr<ForceBlock> cable_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> combination_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& cable_params();
const std::vector<ParamSpec>& combination_params();
// Friction of a cable on what it runs over (core/forces/pulleys.hpp), of cables and winches alike.
ParamSpec pulley_friction_param();
ParamSpec pulley_creep_param();
void fill_pulleys(const ParamSet& values, Force& cable);
void fill_cable(const ParamSet& values, Force& force);
void fill_combination(const ParamSet& values, Force& force);
std::unique_ptr<ForceBlock> axial_spring_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> torsion_spring_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& axial_spring_params();
const std::vector<ParamSpec>& torsion_spring_params();
void fill_axial_spring(const ParamSet& values, Force& force);
void fill_torsion_spring(const ParamSet& values, Force& force);

}  // namespace unfurl
