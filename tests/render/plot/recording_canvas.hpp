// SPDX-License-Identifier: BSD-3-Clause
// A canvas that remembers what it was asked to paint, and a judge of the result.
#pragma once

#include <string>
#include <vector>

#include "render/plot/canvas.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/figure_style.hpp"

namespace unfurl::plot {

class RecordingCanvas final : public Canvas {
 public:
  struct Text {
    std::string text;
    TextStyle style;
    Rect box;
  };

  void polyline(std::span<const Point> points, const Pen& pen) override;
  void band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) override;
  void convex(std::span<const Point> corners, FigureColor fill) override;
  void circle(Point center, double radius, FigureColor fill) override;
  void text(Point at, std::string_view text, const TextStyle& style) override;
  void begin_clip(const Rect& region) override;
  void end_clip() override;

  std::vector<Text> texts;
  std::vector<double> widths;    // of strokes
  std::vector<Point> unclipped;  // points drawn outside a clip region
  std::size_t points = 0;
  bool finite = true;  // every coordinate
  int open_clips = 0;

 private:
  void see(Point p);
};

// What is wrong with a figure as painted in a style, one line a fault: a page of another size than the style
// asks for, text outside, text over text, text too small or large for the style or pale, empty text, strokes
// too thin to print, coordinates that are not finite, strokes off the page.
std::vector<std::string> faults(const Figure& figure, const FigureStyle& style = figure_styles().front());

// What makes curves of a panel hard to tell apart without colour: two named ones of the same dash and marker.
std::vector<std::string> twins(const Figure& figure);

}  // namespace unfurl::plot
