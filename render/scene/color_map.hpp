// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/scene/draw_list.hpp"

namespace unfurl {

// Colours for values, told apart with every kind of colour blindness and by lightness.
// x from -1 (blue) by 0 (a grey that is told from pale and from dark grounds) to 1 (red); Moreland 2009.
Color diverging_color(double x);
Color sequential_color(
    double x);  // x from 0 (dark violet) to 1 (yellow); viridis, Smith and van der Walt 2015

}  // namespace unfurl
