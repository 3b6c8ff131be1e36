// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/shown_lines.hpp"

#include <algorithm>

namespace unfurl {

std::vector<ShownLine> lines_with_springs(const Structure& structure) {
  std::vector<ShownLine> lines = structure.lines;
  const auto copy_of = [&](int node) {
    for (std::size_t i = 0; i < structure.node_copies.size(); ++i)
      if (structure.node_copies[i].source == node) return static_cast<int>(i);
    return -1;
  };
  for (const Force& force : structure.forces) {
    if (force.kind != "spring" || force.measure.kind != MeasureKind::length) continue;
    const int a = copy_of(force.measure.nodes[0]), b = copy_of(force.measure.nodes[1]);
    if (a >= 0 && b >= 0) lines.push_back({a, b, force.one_sided ? "cable" : "spring"});
  }
  return lines;
}

double shown_line_radius(const Structure& structure, double size) {
  double radius = size > 0 ? 0.004 * size : 0.004;
  for (const Rod& rod : structure.rods)
    radius = std::min(radius, rod.radius > 0 ? rod.radius : rod.pinned_length() / 60);
  return 0.4 * radius;
}

}  // namespace unfurl
