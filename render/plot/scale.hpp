// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace unfurl::plot {

// From values to points on the page: lo -> at_lo, hi -> at_hi.
struct Scale {
  double lo = 0, hi = 1;
  double at_lo = 0, at_hi = 1;
  bool log = false;

  // Values far outside stay within reach of single precision.
  double operator()(double value) const {
    const double u = log ? (std::log(value) - std::log(lo)) / (std::log(hi) - std::log(lo))
                         : (value / 2 - lo / 2) / (hi / 2 - lo / 2);
    return at_lo + std::clamp(u, -50.0, 50.0) * (at_hi - at_lo);
  }
};

}  // namespace unfurl::plot
