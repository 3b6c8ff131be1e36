// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// The paper's ring antenna: n re-entrant units around an axis, which share their posts (paper section 4;
// geometry reconstructed). Corners stand at polar angles 2 pi k / n and radius R, each with a post B_k T_k. A
// chord of two rods hinged at Mb_k joins B_k to B_k+1, another one, hinged at Mt_k, joins T_k to T_k+1. With
// the fold angle theta
//
//     z(Mb) = -l2/2 + l1 sin(theta),  z(Mt) = l2/2 - l1 sin(theta),  R = l1 cos(theta) / sin(pi/n)
//
// The full model has 12 n coordinates and 13 n constraints of rank 12 n - 1: planes of symmetry (4 n),
// vertical posts (n), mirror symmetry (n), hinges in the plane of their face (2 n), rods (5 n). The sector
// model solves one sector: nodes B0, T0, Mb0, Mt0, whose chord rods count twice. The joints model
// (hoop_joints.hpp) has no planes of symmetry; it alone may be an open arc or have a unit driven differently.
const std::vector<ParamSpec>& hoop_params();
Structure build_hoop(const ParamSet& params);

}  // namespace unfurl
