// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// A spring and damper on a measure s(q) (core/structure/measure.hpp): with N = k (s - s_0) + c s',
//
//     F = -N ds/dq,     V = k/2 (s - s_0)^2,     dissipated power = c s'^2
//
// One-sided (a cable): nothing where s <= s_0, and N = max(0, N) where s > s_0, so that it never pushes.
//   spring           axial, between two nodes: s is their distance
//   torsion_spring   between two rods: s is their angle, N the torque about the hinge
// `followed`: of each spring, the index of its angle among those that count turns; empty: none does.
std::unique_ptr<ForceBlock> spring_block(const std::vector<Force>& springs, const Deployment& deployment,
                                         const std::vector<int>& followed = {});
std::unique_ptr<ForceBlock> axial_spring_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> torsion_spring_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& axial_spring_params();
const std::vector<ParamSpec>& torsion_spring_params();
void fill_axial_spring(const ParamSet& values, Force& force);
void fill_torsion_spring(const ParamSet& values, Force& force);

}  // namespace unfurl
