// SPDX-License-Identifier: BSD-3-Clause
// What is seen between nodes and is no rod.
#pragma once

#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

// Cables and nets, and springs between two nodes as straight lines of the group "spring".
std::vector<ShownLine> lines_with_springs(const Structure& structure);

// Thinner than any rod, and seen [m]: of cables and springs in pictures that others draw.
double shown_line_radius(const Structure& structure, double size);

}  // namespace unfurl
