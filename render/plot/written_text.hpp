// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "render/plot/canvas.hpp"

namespace unfurl::plot {

// All that a figure has written, one text after the other.
class WrittenText final : public Canvas {
 public:
  const std::string& all() const { return all_; }

  void polyline(std::span<const Point>, const Pen&) override {}
  void band(std::span<const Point>, std::span<const Point>, FigureColor) override {}
  void convex(std::span<const Point>, FigureColor) override {}
  void circle(Point, double, FigureColor) override {}
  void text(Point, std::string_view text, const TextStyle&) override { all_ += text; }
  void begin_clip(const Rect&) override {}
  void end_clip() override {}

 private:
  std::string all_;
};

}  // namespace unfurl::plot
