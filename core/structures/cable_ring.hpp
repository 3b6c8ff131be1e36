// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// A ring of n (even) bays, each a parallelogram of two longerons and two battens, as rims of large mesh
// antennas have them. Battens stay parallel; every second one goes up, the others go down by half of
// L sin(fold) as the ring folds:
//
//     batten k at the angle 2 pi k / n, radius R = L cos(fold) / (2 sin(pi / n)), height -+ L sin(fold) / 2
//
// Hinges at the battens' ends keep the angle between neighbouring bays (a dihedral about the batten);
// synchronising gears there make both longerons of a batten turn alike. One cable runs through telescoping
// diagonals, from the lower corner of every bay to its upper one, all around the ring: drawn in, it deploys
// the ring,
//
//     S = n sqrt(L^2 + h^2 + 2 h L sin(fold))
//
// Nodes: Bk, Tk, the battens' ends. It floats freely.
const std::vector<ParamSpec>& cable_ring_params();
Structure build_cable_ring(const ParamSet& params);

}  // namespace unfurl
