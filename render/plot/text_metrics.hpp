// SPDX-License-Identifier: BSD-3-Clause
// How wide text is, without a font file and without OpenGL: layout is the same for every canvas.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/plot/canvas.hpp"

namespace unfurl::plot {

// Of digits and capitals above the baseline, and of descenders below it, relative to the size.
inline constexpr double cap_height = 0.729, ascent = 0.76, descent = 0.22;

// Advance of one line of UTF-8 text in typeface(), without kerning [points].
double text_width(std::string_view text, double size);
// Height of a line of DejaVu Sans, ascenders of any language included, relative to the size.
inline constexpr double line_height = 2384.0 / 2048.0;

// What the text covers, capitals and descenders included.
Rect text_box(Point at, std::string_view text, const TextStyle& style);

// Broken at spaces into lines that fit into `width`.
std::vector<std::string> wrap_text(std::string_view text, double size, double width);
// Ends in an ellipsis where it does not fit.
std::string shorten_text(std::string_view text, double size, double width);

}  // namespace unfurl::plot
