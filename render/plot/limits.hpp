// SPDX-License-Identifier: BSD-3-Clause
// From which to which value an axis runs.
#pragma once

#include <vector>

#include "render/plot/figure.hpp"

namespace unfurl::plot {

struct Limits {
  double lo = 0, hi = 1;
};

enum class AxisOf { x, y, y2 };

// The axis's own limits where it has them; else those of the data and of the reference lines, with some air.
// Finite and lo < hi whatever the data: none, one value, NaN, infinities, all zero; 0 < lo on log axes.
Limits axis_limits(const Panel& panel, AxisOf which);

// Whether a log axis of this panel draws exact zeros of its curves at its floor.
bool has_floored_zeros(const Panel& panel);

}  // namespace unfurl::plot
