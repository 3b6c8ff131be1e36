// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/scaled_canvas.hpp"

namespace unfurl::plot {

std::vector<Point> ScaledCanvas::scaled(std::span<const Point> points) const {
  std::vector<Point> out;
  out.reserve(points.size());
  for (const Point& p : points) out.push_back(scaled(p));
  return out;
}

void ScaledCanvas::polyline(std::span<const Point> points, const Pen& pen) {
  canvas_.polyline(scaled(points), {pen.color, scale_ * pen.width, pen.dash});
}

void ScaledCanvas::band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) {
  canvas_.band(scaled(lower), scaled(upper), fill);
}

void ScaledCanvas::convex(std::span<const Point> corners, FigureColor fill) {
  canvas_.convex(scaled(corners), fill);
}

void ScaledCanvas::circle(Point center, double radius, FigureColor fill) {
  canvas_.circle(scaled(center), scale_ * radius, fill);
}

void ScaledCanvas::text(Point at, std::string_view text, const TextStyle& style) {
  TextStyle larger = style;
  larger.size *= scale_;
  canvas_.text(scaled(at), text, larger);
}

void ScaledCanvas::begin_clip(const Rect& r) {
  canvas_.begin_clip({scale_ * r.x0, scale_ * r.y0, scale_ * r.x1, scale_ * r.y1});
}

void ScaledCanvas::end_clip() {
  canvas_.end_clip();
}

}  // namespace unfurl::plot
