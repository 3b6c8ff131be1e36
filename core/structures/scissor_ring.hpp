// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// A closed pantograph ring of n units around the z axis: neighbouring corners, each a lower node B_k and an
// upper node T_k, are joined by two rods of length l that cross and are pinned at their middles P_k. With
// theta the angle of the rods with the ring's plane
//
//     height h = l sin(theta),  side w = l cos(theta),  radius R = w / (2 sin(pi/n))
//
// so a bundle at 90 degrees opens to a flat ring at 0. The corners' lower nodes and the pins move in planes
// of symmetry; that alone leaves the polygon no other shape.
const std::vector<ParamSpec>& scissor_ring_params();
Structure build_scissor_ring(const ParamSet& params);

}  // namespace unfurl
