// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/plot/layout.hpp"
#include "render/plot/placement.hpp"

namespace unfurl::plot {

// Everything that a panel draws inside its frame; needs axes and traces, and the legend where there is one.
Obstacles obstacles_of(const Panel& panel, const PanelLayout& layout);

}  // namespace unfurl::plot
