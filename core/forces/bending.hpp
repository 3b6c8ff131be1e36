// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Bending at the middle one of three nodes, between the segments d_1 = x_1 - x_0 and d_2 = x_2 - x_1 of a rod
// that is straight without force (discrete elastic rods, Bergou et al. 2008). With the unit vectors t_i of
// the segments, c = t_1 . t_2, and L the mean of the segments' lengths at t = 0,
//
//     kappa = 2 t_1 x t_2 / (1 + c),     V = (E I / 2 L) |kappa|^2 = (2 E I / L) (1 - c) / (1 + c)
//
// smooth where straight, and infinite where folded back. With the damping time T of the material the moment
// is that of |kappa| + T |kappa|', F = -dR/dv of
//
//     R = c/2 (|kappa|')^2,   c = T E I / L,   |kappa|' = s . s' / (|s| cos^3 of half the angle),  s = t_2 -
//     t_1
//
// What turns the plane of the bend costs nothing, as the rod may spin with it. Where straight there is no
// such plane, and bends in all directions are damped alike: (s . s')^2 / |s|^2 is
// ((s . s')^2 + e^2 |s'|^2) / (|s|^2 + e^2), e = 1e-6, which in a plane is the same at every s.
std::unique_ptr<ForceBlock> bending_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& bending_params();
void fill_bending(const ParamSet& values, Force& force);

}  // namespace unfurl
