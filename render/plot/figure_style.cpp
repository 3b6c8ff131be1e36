// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figure_style.hpp"

#include <algorithm>
#include <array>

#include "render/plot/style.hpp"

namespace unfurl {
namespace {

// Columns as journals have them (Nature, Elsevier: 89 or 90 mm and 183 or 190 mm) with text of 5 to 7 points;
// a slide of 16:9, 10 inches wide: 1920 x 1080 pixels.
constexpr std::array styles{
    FigureStyle{"screen", "160 mm wide, text of 7 to 9 points, title and caption inside, 300 dpi", 0, 0, 1, 1,
                300, true, true},
    FigureStyle{"single-column", "89 mm wide, text of 5 to 7 points, without title and caption, 600 dpi", 89,
                0, 1.1, 0.75, 600, false, false},
    FigureStyle{"double-column", "183 mm wide, text of 5 to 7 points, without title and caption, 600 dpi",
                183, 0, 1.35, 0.75, 600, false, false},
    FigureStyle{"slide", "254 x 142.9 mm (1920 x 1080 pixels), text of 13 to 17 points, without caption", 254,
                142.875, 1, 1.9, 192, true, false},
};

// What a figure is less high without what a style leaves out [mm].
double left_out(const Figure& figure, const FigureStyle& style) {
  double points = 0;
  if (!style.title && !figure.title.empty()) points += 1.5 * plot::title_size;
  if (!style.caption && !figure.caption.empty()) {
    const double width = figure.width_mm * plot::points_per_mm - 8;
    const auto lines =
        plot::caption_lines(figure.caption, width, figure.height_mm * plot::points_per_mm).size();
    points += 5 + plot::line_spacing * plot::small_size * static_cast<double>(lines);
  }
  return points / plot::points_per_mm;
}

}  // namespace

std::span<const FigureStyle> figure_styles() {
  return styles;
}

const FigureStyle* find_figure_style(std::string_view name) {
  for (const FigureStyle& style : styles)
    if (style.name == name) return &style;
  return nullptr;
}

plot::LayoutOptions layout_options(const Figure& figure, const FigureStyle& style) {
  plot::LayoutOptions out{style.title, style.caption};
  out.scale = style.scale;
  out.width_mm = style.width_mm > 0 ? style.width_mm / style.scale : figure.width_mm;
  const bool to_scale =
      std::any_of(figure.panels.begin(), figure.panels.end(), [](const Panel& p) { return p.equal_scale; });
  const double height = figure.height_mm - left_out(figure, style);
  // Titles of panels and a legend keep their height where the drawing becomes smaller.
  constexpr double fixed_mm = 16;
  out.height_mm = style.height_mm > 0 ? style.height_mm / style.scale
                  : to_scale          ? fixed_mm + (height - fixed_mm) * out.width_mm / figure.width_mm
                                      : height * style.stretch;
  return out;
}

}  // namespace unfurl
