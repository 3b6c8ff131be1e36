// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

#include <functional>
#include <span>
#include <vector>

#include "render/plot/canvas.hpp"

namespace unfurl::plot {

// Paints with an ImGui draw list: a figure in a picture, or in a panel of a window.
class ImguiCanvas final : public Canvas {
 public:
  // `fonts`: the font whose lines are so many pixels high. `origin`: the figure's upper left corner in
  // pixels.
  using Fonts = std::function<ImFont*(float pixels)>;
  // `tolerance`: how far a curve may be from its points [pixels]; what costs is corners, which a smooth curve
  // on a screen has far more of than anyone sees.
  ImguiCanvas(ImDrawList& list, Fonts fonts, double pixels_per_point, Point origin = {},
              double tolerance = 0);
  ~ImguiCanvas() override;
  ImguiCanvas(const ImguiCanvas&) = delete;
  ImguiCanvas& operator=(const ImguiCanvas&) = delete;

  // The height of a line of text of a size [points] in pixels: the fonts that will be asked for.
  static float font_pixels(double size, double pixels_per_point);

  void polyline(std::span<const Point> points, const Pen& pen) override;
  void band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) override;
  void convex(std::span<const Point> corners, FigureColor fill) override;
  void circle(Point center, double radius, FigureColor fill) override;
  void text(Point at, std::string_view text, const TextStyle& style) override;
  void begin_clip(const Rect& region) override;
  void end_clip() override;

 private:
  ImVec2 pixel(Point p) const;
  // Lines in pixels.
  void stroke(std::span<const ImVec2> points, float width, ImU32 color, bool round_ends);
  void straight(ImVec2 a, ImVec2 b, float width, ImU32 color);
  void dashed(std::span<const ImVec2> points, std::span<const double> pattern, float width, ImU32 color);

  ImDrawList& list_;
  Fonts fonts_;
  double scale_;
  Point origin_;
  float tolerance_;
  ImDrawListFlags flags_;  // of the list before
};

// Some of the points, among them the first and the last, such that the line through them passes no point that
// was left out by more than `tolerance`, and takes no short cut where it turns back.
std::vector<ImVec2> straightened(std::span<const ImVec2> points, float tolerance);

}  // namespace unfurl::plot
