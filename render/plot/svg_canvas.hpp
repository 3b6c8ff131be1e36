// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "render/plot/canvas.hpp"

namespace unfurl::plot {

// Writes SVG 1.1: text as <text> elements, one drawing unit a point, the size in millimetres.
class SvgCanvas final : public Canvas {
 public:
  // title and description: for screen readers and search.
  SvgCanvas(double width, double height, std::string_view title, std::string_view description);

  void polyline(std::span<const Point> points, const Pen& pen) override;
  void band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) override;
  void convex(std::span<const Point> corners, FigureColor fill) override;
  void circle(Point center, double radius, FigureColor fill) override;
  void text(Point at, std::string_view text, const TextStyle& style) override;
  void begin_clip(const Rect& region) override;
  void end_clip() override;

  // The whole document. Call once, at the end.
  std::string finish();

 private:
  void number(double value);
  void point(Point p);
  void points(std::span<const Point> points);
  void paint(const char* what, FigureColor color);

  std::string out_;
  int clips_ = 0;
};

}  // namespace unfurl::plot
