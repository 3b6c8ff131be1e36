// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// Hoberman's ring: n pairs of angulated elements in the plane z = 0 (Hoberman, US patent 4,942,700; You and
// Pellegrino, Int. J. Solids Struct. 34, 1997). An element is two bars of length p, rigidly joined at P under
// the angle pi - alpha, alpha = 2 pi/n. Two of them cross at each P_k (polar angle alpha k) and end at the
// inner nodes I_k and the outer nodes O_k (angle alpha (k + 1/2)). With the fold angle theta (gamma = pi/2 -
// theta)
//
//     |P| = p sin(gamma) / sin(alpha/2),   |O|, |I| = p sin(gamma +- alpha/2) / sin(alpha/2)
//
// The kink is held by a massless brace between the element's ends; pins P_k slide on radial rails.
const std::vector<ParamSpec>& hoberman_params();
Structure build_hoberman(const ParamSet& params);

}  // namespace unfurl
