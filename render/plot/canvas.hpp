// SPDX-License-Identifier: BSD-3-Clause
// What a figure is painted on. Lengths are points (1/72 inch) from the top left corner, y downwards.
#pragma once

#include <span>
#include <string_view>

#include "render/plot/figure.hpp"

namespace unfurl::plot {

struct Point {
  double x = 0, y = 0;
};

struct Rect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // left, top, right, bottom

  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
  bool overlaps(const Rect& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
  bool contains(const Rect& o) const { return o.x0 >= x0 && o.x1 <= x1 && o.y0 >= y0 && o.y1 <= y1; }
  Rect grown(double by) const { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
};

struct Pen {
  FigureColor color;
  double width = 1.0;
  Dash dash = Dash::solid;
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size = 7.0;
  FigureColor color;
  Anchor anchor = Anchor::start;
  bool upward = false;  // turned a quarter to the left: reads from the bottom to the top
};

class Canvas {
 public:
  virtual ~Canvas() = default;
  // Round ends and joints.
  virtual void polyline(std::span<const Point> points, const Pen& pen) = 0;
  // The region between two lines of equally many points with the same x.
  virtual void band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) = 0;
  virtual void convex(std::span<const Point> corners, FigureColor fill) = 0;
  virtual void circle(Point center, double radius, FigureColor fill) = 0;
  // `at`: where the baseline starts, has its middle or ends, by the style's anchor. UTF-8.
  virtual void text(Point at, std::string_view text, const TextStyle& style) = 0;
  // Nothing outside is painted until end_clip. Clips do not nest.
  virtual void begin_clip(const Rect& region) = 0;
  virtual void end_clip() = 0;

  void line(Point a, Point b, const Pen& pen);
  void rectangle(const Rect& r, FigureColor fill);
  void marker(Marker kind, Point center, double radius, FigureColor fill);
};

// Lengths of strokes and gaps for a line of some width [points]; empty: solid.
std::span<const double> dash_pattern(Dash dash);

}  // namespace unfurl::plot
