// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/plot/canvas.hpp"
#include "render/plot/layout.hpp"

namespace unfurl::plot {

// The rods and joints of a pose, the farthest first. A near rod parts the ones behind it by a white edge, and
// far ones are a little lighter, so that a crossing reads as one in space.
void paint_pose(const Panel& panel, const PanelLayout& layout, Canvas& canvas);

}  // namespace unfurl::plot
