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

}  // namespace unfurl
