// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// Bricard's loop of six equal bars with threefold symmetry (Bricard, J. Math. Pures Appl. 1897; Chen, You and
// Tarnai, Int. J. Solids Struct. 42, 2005): the hinge axes at the ends of a bar stand across it and make the
// twist angle alpha with each other. A spatial loop of six bars and six hinges has in general no mobility;
// this one has one.
//
// Hinges X1, X3, X5 stand at polar angles 0, 120, 240 degrees, radius r1 and height z1, hinges X2, X4, X6
// between them at r2, z2. With theta_1 and theta_2 the angles between the bars at the odd and at the even
// hinges, S = sin(theta/2), C = cos(theta/2) and bars of length L
//
//     r1 = 2/sqrt(3) L S_2,  r2 = 2/sqrt(3) L S_1,  (z2 - z1)^2 / L^2 = 1 - 4/3 (S_1^2 - S_1 S_2 + S_2^2)
//     S_1 S_2 - 1/2 = cos(alpha) C_1 C_2                                                      (closure)
//
// At alpha = 120 degrees it opens from a bundle (theta = 0) to a flat triangle (theta_1 = 180, theta_2 = 60
// degrees).
//
// An axis is a pin, a rod X_i Y_i of its own; massless braces fix the angles between bars and pins: 30
// lengths for 36 coordinates, one of which follows from the others.
const std::vector<ParamSpec>& bricard_params();
Structure build_bricard(const ParamSet& params);

}  // namespace unfurl
