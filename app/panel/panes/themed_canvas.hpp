// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

#include "render/plot/canvas.hpp"

namespace unfurl {

// The ground of figures in the panel.
ImVec4 figure_paper(bool dark);

// Passes everything on to another canvas; on a dark ground with colours of the other lightness.
class ThemedCanvas final : public plot::Canvas {
 public:
  ThemedCanvas(plot::Canvas& target, bool dark) : target_(target), dark_(dark) {}

  void polyline(std::span<const plot::Point> points, const plot::Pen& pen) override {
    target_.polyline(points, {themed(pen.color), pen.width, pen.dash});
  }
  void band(std::span<const plot::Point> lower, std::span<const plot::Point> upper,
            FigureColor fill) override {
    target_.band(lower, upper, themed(fill));
  }
  void convex(std::span<const plot::Point> corners, FigureColor fill) override {
    target_.convex(corners, themed(fill));
  }
  void circle(plot::Point center, double radius, FigureColor fill) override {
    target_.circle(center, radius, themed(fill));
  }
  void text(plot::Point at, std::string_view text, const plot::TextStyle& style) override {
    plot::TextStyle other = style;
    other.color = themed(style.color);
    target_.text(at, text, other);
  }
  void begin_clip(const plot::Rect& region) override { target_.begin_clip(region); }
  void end_clip() override { target_.end_clip(); }

 private:
  FigureColor themed(FigureColor color) const;

  plot::Canvas& target_;
  bool dark_;
};

}  // namespace unfurl
