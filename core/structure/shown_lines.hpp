// SPDX-License-Identifier: BSD-3-Clause
// What is seen between nodes and is no rod.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/structure/structure.hpp"

namespace unfurl {

// Solved nodes in a row [two or more each]: the ends of a telescope's stages, and of lengths that are driven
// or held where no rod is.
std::vector<std::vector<int>> telescopes(const Structure& structure);

// The stretches of a path in order, as solved nodes; what a drum has drawn in has none.
std::vector<std::pair<int, int>> stretches(const Measure& path);

// A span of a cable or a net, and what pulls it: its place among the forces or, of a cable that is reeled,
// among the stops; -1: not among them.
struct CableSpan {
  ShownLine line;
  int force = -1, stop = -1;
  std::size_t term = 0;  // of their measure, one length by itself has none
};
// Those of Structure::lines, in their order.
std::vector<CableSpan> cable_spans(const Structure& structure);

// Cables and nets, springs between two nodes as straight lines of the group "spring", and of "actuator" what
// telescopes() has.
std::vector<ShownLine> lines_between_nodes(const Structure& structure);

// Thinner than any rod, and seen [m]: of cables and springs in pictures that others draw.
double shown_line_radius(const Structure& structure, double size);

}  // namespace unfurl
