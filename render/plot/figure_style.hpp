// SPDX-License-Identifier: BSD-3-Clause
// For which page a figure is made: its width, the size of its text, the resolution of its pixels.
#pragma once

#include <span>
#include <string_view>

#include "render/plot/figure.hpp"
#include "render/plot/layout.hpp"

namespace unfurl {

struct FigureStyle {
  std::string_view name, help;
  double width_mm;   // 0: the figure's own
  double height_mm;  // 0: the figure's own, less the title and caption left out, times `stretch`
  double stretch;
  double scale;  // of text, lines and gaps: 1 has text of 7 to 9 points
  double dpi;    // of a PNG [pixels per inch]
  bool title, caption;
};

// The first one is the default.
std::span<const FigureStyle> figure_styles();
const FigureStyle* find_figure_style(std::string_view name);  // nullptr where there is none

// How to lay a figure out in a style.
plot::LayoutOptions layout_options(const Figure& figure, const FigureStyle& style);

}  // namespace unfurl
