// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/plot/canvas.hpp"
#include "render/plot/layout.hpp"

namespace unfurl::plot {

// Paint a figure that was laid out (layout.hpp) on a canvas of the layout's size.
void paint(const Figure& figure, const FigureLayout& layout, Canvas& canvas);

}  // namespace unfurl::plot
