// SPDX-License-Identifier: BSD-3-Clause
// The parts of a panel's layout, in the order in which layout.cpp needs them.
#pragma once

#include "render/plot/layout.hpp"
#include "render/plot/limits.hpp"
#include "render/plot/style.hpp"

namespace unfurl::plot {

struct Margins {
  double left = 0, right = 0, top = 0, bottom = 0;  // between a panel's cell and its frame [points]
};

// Scales and ticks for a frame.
void set_axes(const Panel& panel, PanelLayout& out);
// What titles, ticks and axis labels need around the frame; set_axes first. `legend_rows`: above the frame.
Margins margins(const Panel& panel, const PanelLayout& layout, int legend_rows);
// Curves and bands in points.
void set_traces(const Panel& panel, PanelLayout& out);
// Titles, tick labels and axis labels. `cell`: the frame with its margins.
void add_axis_labels(const Panel& panel, const Rect& cell, int legend_rows, PanelLayout& out);
// The labels of reference lines and the scale bar; needs traces and the legend.
void add_inner_labels(const Panel& panel, PanelLayout& out);

inline constexpr double legend_row_height = 9.6;
inline constexpr double panel_title_height = 12.0, note_height = 10.0;
inline constexpr double scale_bar_height = small_size + 9.0;  // below a frame
// Between the title and what stands at the upper edge of a frame without axes.
inline constexpr double bare_gap = 3.0;

bool has_note(const PanelLayout& layout);  // of a y axis, above the frame

}  // namespace unfurl::plot
