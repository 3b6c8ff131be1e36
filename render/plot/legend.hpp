// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/plot/layout.hpp"

namespace unfurl::plot {

// Rows that the legend takes above a frame of this width; 0 where the panel has no labelled curve or band.
int legend_rows(const Panel& panel, double width);
// The legend inside the frame where it hides nothing; nullopt where there is no such place. Needs axes and
// traces.
std::optional<Legend> inside_legend(const Panel& panel, const PanelLayout& layout);
// The legend in rows, its lower edge at `bottom`.
Legend legend_above(const Panel& panel, const Rect& frame, double bottom);

}  // namespace unfurl::plot
