// SPDX-License-Identifier: BSD-3-Clause
// Rods that bend: cut into segments.
#pragma once

#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

// Cuts rod r into segments[r] equal parts, with pins between them that resist bending by E I
// (forces/bending.hpp): nodes "A-B.1", "A-B.2", ... and rods of the same names. The rods' ends stay pins.
// Each part has its share of mass and length, and knows the whole rod: buckling and names go by that. Throws
// StructureError with the key "segments" where a rod has no modulus or no second moment, in sector models,
// and where a pin sits between the ends of rods: such a pin would not follow the bent rod.
void cut_rods(Structure& structure, const std::vector<long>& segments);

// A rod bends at the nodes within it, each for half a part on either side; the half parts at its ends are
// left out, as pins leave no moment there. Where an angle of six nodes (angle_sides.hpp) acts on a rod's end,
// it takes the tangent of a rod that bends there as it does at the first node, from that on back to the end:
// with 1.5 of the parts to bend the stiffness there is that much larger, and deflections are right to the
// second order in 1/k. What is measured only, how far a structure is deployed that is not locked there, makes
// nothing stiffer. Friction by the force of a pin needs the first part's own direction: where a structure
// has it (by_pin), angles are those of the parts, of first order, and a note says so.
void bend_to_ends(Structure& structure, bool by_pin, bool locks_deployed);

}  // namespace unfurl
