// SPDX-License-Identifier: BSD-3-Clause
// Where everything of a figure goes on the page. Independent of the canvas, so that PNG and SVG agree.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/plot/canvas.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/scale.hpp"
#include "render/plot/ticks.hpp"
#include "render/plot/trace.hpp"

namespace unfurl::plot {

struct Label {
  Point at;
  std::string text;
  TextStyle style;
  bool backed = false;  // on a white ground, because it covers a line
};

// A legend's entry: a sample of a curve or a band, then its label. Neither: of what is left out.
struct LegendEntry {
  const Curve* curve = nullptr;
  const Band* band = nullptr;
  Point sample;  // the left end of the sample's middle line
  Label label;
};

struct Legend {
  Rect box;
  bool inside = true;  // in the frame, on a white ground; false: above it
  std::vector<LegendEntry> entries;
};
inline constexpr double legend_sample = 19.0;  // length of a sample [points]

struct AxisLayout {
  bool used = true;
  Scale scale;
  Ticks ticks;
};

struct PanelLayout {
  Rect frame;  // what the axes span
  AxisLayout x, y, y2;
  std::vector<std::vector<Polyline>> curves;  // the pieces of each curve
  std::vector<BandTrace> bands;
  std::optional<Legend> legend;
  std::vector<Label> labels;      // all other text
  std::optional<Rect> scale_bar;  // its stroke
};

struct FigureLayout {
  double width = 0, height = 0;     // [points]
  double scale = 1;                 // of everything on its way to paper
  std::vector<PanelLayout> panels;  // as many as the figure has
  std::vector<Label> labels;        // title and caption
};

struct LayoutOptions {
  bool title = true, caption = true;
  double width_mm = 0, height_mm = 0;  // 0: the figure's own
  double scale = 1;  // the page is so many times as large as laid out, with all that is on it
};

// A caption in lines of `width` that take half of the page at most: what is longer ends in dots [points].
std::vector<std::string> caption_lines(const std::string& caption, double width, double page_height);
// The figure must outlive the layout.
FigureLayout lay_out(const Figure& figure, const LayoutOptions& options = {});

}  // namespace unfurl::plot
