// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/plot/canvas.hpp"

namespace unfurl::plot {

// Paints on another canvas, everything `scale` times as large.
class ScaledCanvas final : public Canvas {
 public:
  ScaledCanvas(Canvas& canvas, double scale) : canvas_(canvas), scale_(scale) {}

  void polyline(std::span<const Point> points, const Pen& pen) override;
  void band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) override;
  void convex(std::span<const Point> corners, FigureColor fill) override;
  void circle(Point center, double radius, FigureColor fill) override;
  void text(Point at, std::string_view text, const TextStyle& style) override;
  void begin_clip(const Rect& region) override;
  void end_clip() override;

 private:
  Point scaled(Point p) const { return {scale_ * p.x, scale_ * p.y}; }
  std::vector<Point> scaled(std::span<const Point> points) const;

  Canvas& canvas_;
  double scale_;
};

}  // namespace unfurl::plot
