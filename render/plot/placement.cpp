// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace unfurl::plot {

double length_inside(Point a, Point b, const Rect& box) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  double from = 0, to = 1;  // Liang and Barsky: the stretch of the line between each pair of edges
  const auto cut = [&](double start, double slope, double lo, double hi) {
    if (slope == 0) return start >= lo && start <= hi;
    const double u = (lo - start) / slope, v = (hi - start) / slope;
    from = std::max(from, std::min(u, v));
    to = std::min(to, std::max(u, v));
    return true;
  };
  if (!cut(a.x, dx, box.x0, box.x1) || !cut(a.y, dy, box.y0, box.y1)) return 0;
  return to > from ? (to - from) * std::hypot(dx, dy) : 0;
}

double Obstacles::hidden(const Rect& box) const {
  double sum = 0;
  for (const Rect& other : boxes_)
    if (box.overlaps(other)) sum += touches_text;
  for (const Polyline& line : lines_) {
    if (line.size() == 1 && box.contains({line[0].x, line[0].y, line[0].x, line[0].y})) sum += 3;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Point &a = line[i - 1], &b = line[i];
      const bool apart = std::max(a.x, b.x) < box.x0 || std::min(a.x, b.x) > box.x1 ||
                         std::max(a.y, b.y) < box.y0 || std::min(a.y, b.y) > box.y1;
      if (!apart) sum += length_inside(a, b, box);
    }
  }
  return sum;
}

Spot free_spot(const Obstacles& obstacles, const Rect& region, double width, double height) {
  constexpr int columns = 16, rows = 12;
  const double dx = (region.width() - width) / columns, dy = (region.height() - height) / rows;
  Spot best{{}, 1e300};
  double best_cost = 1e300;
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) {
      const double x = region.x1 - width - i * dx, y = region.y0 + j * dy;
      const Rect box{x, y, x + width, y + height};
      // Edges and corners read better than the middle: a fifth of a point for a step away from the nearest.
      const double away = std::min(i, columns - i) + std::min(j, rows - j) + 0.1 * (i > 0) + 0.2 * (j > 0);
      const double hidden = obstacles.hidden(box.grown(2.5));
      const double cost = hidden + 0.2 * away;
      if (cost < best_cost) best_cost = cost, best = {box, hidden};
    }
  }
  return best;
}

}  // namespace unfurl::plot
