// SPDX-License-Identifier: BSD-3-Clause
// How figures look: sizes in points (1/72 inch) at print size, colours.
#pragma once

#include <array>

#include "render/plot/figure.hpp"

namespace unfurl::plot {

inline constexpr double points_per_mm = 72.0 / 25.4;

inline constexpr double title_size = 9.0;
inline constexpr double label_size = 8.0;  // axis labels, panel titles
inline constexpr double small_size = 7.0;  // tick labels, legends, labels of lines, captions
inline constexpr std::array text_sizes{small_size, label_size, title_size};
inline constexpr double line_spacing = 1.35;  // of caption lines, relative to the size

inline constexpr double axis_width = 0.6, grid_width = 0.4, reference_width = 0.7;
inline constexpr double tick_length = 3.0, minor_tick_length = 1.7;

inline constexpr FigureColor white{1, 1, 1, 1};
inline constexpr FigureColor ink{0.13f, 0.13f, 0.13f, 1};
inline constexpr FigureColor axis_color{0.3f, 0.3f, 0.3f, 1};
inline constexpr FigureColor grid_color{0.91f, 0.91f, 0.91f, 1};
inline constexpr FigureColor caption_color{0.33f, 0.33f, 0.33f, 1};
inline constexpr float band_opacity = 0.22f;

// `share` of white mixed into a colour.
FigureColor lighter(FigureColor color, float share);
// How far a colour stands out from white: 1 not at all, 21 black (relative luminance as in WCAG 2).
double contrast_on_white(FigureColor color);
// The colour, darkened where it must be for small text: contrast of 4.5 or more.
FigureColor readable(FigureColor color);

}  // namespace unfurl::plot
