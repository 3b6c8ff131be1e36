// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/plot/layout.hpp"

namespace unfurl::plot {

// Whether the panel has a labelled curve or band.
bool has_legend(const Panel& panel);
// Rows that the legend takes above a frame in this width, so many at most.
int legend_rows(const Panel& panel, double width, int most);
// The legend inside the frame where it hides nothing; nullopt where there is no such place. Needs axes and
// traces.
std::optional<Legend> inside_legend(const Panel& panel, const PanelLayout& layout);
// The legend in rows, `at` its lower left corner. What more than `most` rows would hold is counted in the
// last entry: "and 3 more".
Legend legend_above(const Panel& panel, Point at, double width, int most);

}  // namespace unfurl::plot
