// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/canvas.hpp"

#include <array>
#include <cmath>

namespace unfurl::plot {

void Canvas::line(Point a, Point b, const Pen& pen) {
  const std::array points{a, b};
  polyline(points, pen);
}

void Canvas::rectangle(const Rect& r, FigureColor fill) {
  const std::array<Point, 4> corners{Point{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}};
  convex(corners, fill);
}

void Canvas::marker(Marker kind, Point c, double r, FigureColor fill) {
  switch (kind) {
    case Marker::none:
      return;
    case Marker::circle:
      return circle(c, r, fill);
    case Marker::square:
      return rectangle({c.x - 0.9 * r, c.y - 0.9 * r, c.x + 0.9 * r, c.y + 0.9 * r}, fill);
    case Marker::triangle: {
      const std::array<Point, 3> corners{
          Point{c.x, c.y - 1.2 * r}, {c.x + 1.1 * r, c.y + 0.8 * r}, {c.x - 1.1 * r, c.y + 0.8 * r}};
      return convex(corners, fill);
    }
    case Marker::diamond: {
      const std::array<Point, 4> corners{
          Point{c.x, c.y - 1.3 * r}, {c.x + 1.3 * r, c.y}, {c.x, c.y + 1.3 * r}, {c.x - 1.3 * r, c.y}};
      return convex(corners, fill);
    }
  }
}

std::span<const double> dash_pattern(Dash dash) {
  static constexpr std::array dashed{5.0, 2.6}, dotted{1.2, 1.9}, long_dashed{10.0, 3.0};
  static constexpr std::array dash_dot{6.0, 2.2, 1.2, 2.2};
  static constexpr std::array dash_dot_dot{6.0, 2.0, 1.2, 2.0, 1.2, 2.0};
  switch (dash) {
    case Dash::solid:
      return {};
    case Dash::dashed:
      return dashed;
    case Dash::dotted:
      return dotted;
    case Dash::dash_dot:
      return dash_dot;
    case Dash::long_dashed:
      return long_dashed;
    case Dash::dash_dot_dot:
      return dash_dot_dot;
  }
  return {};
}

}  // namespace unfurl::plot
