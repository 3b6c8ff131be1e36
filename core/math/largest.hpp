// SPDX-License-Identifier: BSD-3-Clause
// Maxima that keep a NaN, which std::max drops: what is not a number is never the best of a list.
#pragma once

#include <cmath>
#include <span>

namespace unfurl {

// The larger of the two; NaN where one of them is.
inline double larger(double a, double b) {
  return a >= b || std::isnan(a) ? a : b;
}

// The largest |x|; 0 of none, NaN where one is.
inline double largest_magnitude(std::span<const double> values) {
  double most = 0;
  for (const double x : values) most = larger(most, std::abs(x));
  return most;
}

}  // namespace unfurl
