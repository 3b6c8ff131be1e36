// SPDX-License-Identifier: BSD-3-Clause
// What stands beside the picture of a figure: the numbers drawn and its caption.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "render/plot/figure.hpp"

namespace unfurl {

// The first line of every table of a figure's numbers.
inline constexpr const char* figure_csv_header = "panel,kind,series,x,y,x_end,y_end\n";

// One row per point: panel (from 1), kind, the legend's name of the series (or its axis), x, y.
// Kinds: `title`, `x_axis`, `y_axis`, `right_axis` (the name stands in the column series); `curve`,
// `right_curve`; `band` (from y to y_end); `line` (a reference line at x or at y); `rod` (from x, y to x_end,
// y_end, as projected), `node`; `cell` (of a map, the corners; its value or verdict in the column series).
// Numbers in full precision; empty cells are NaN.
std::string figure_csv(const Figure& figure);
// Title and caption as one paragraph.
std::string figure_caption(const Figure& figure);

// NAME.csv and NAME.caption.txt beside the picture NAME.png.
std::array<std::filesystem::path, 2> figure_data_files(const std::filesystem::path& picture);

// Throws FileError where the files beside the picture are there and are not those of a figure: to be asked
// before the picture is written.
void refuse_other_data(const std::filesystem::path& picture);

// Writes both. Throws FileError, also where NAME.csv is
// something else than the table of a figure.
void write_figure_data(const Figure& figure, const std::filesystem::path& picture);

}  // namespace unfurl
