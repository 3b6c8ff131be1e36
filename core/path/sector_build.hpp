// SPDX-License-Identifier: BSD-3-Clause
// The structure of one sector.
#pragma once

#include "core/path/symmetry.hpp"

namespace unfurl {

struct SectorStructure {
  Structure structure;
  // Where the sector has what it keeps of the whole; -1: it has an image of it, or nothing.
  std::vector<int> node_at, rod_at, constraint_at;
};

// Throws SectorRefused.
SectorStructure build_sector_structure(const Structure& whole, const System& system,
                                       const Symmetry& symmetry);

}  // namespace unfurl
