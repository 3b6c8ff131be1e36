// SPDX-License-Identifier: BSD-3-Clause
// Polynomials through a few points. For points that are used again and again, core/math/barycentric.hpp.
#pragma once

#include <cstddef>

namespace unfurl {

// The weight of point a in the polynomial through `points` of them, at t; time(b) is where point b lies.
template <class TimeOf>
double lagrange_weight(std::size_t a, std::size_t points, double t, const TimeOf& time) {
  double out = 1;
  for (std::size_t b = 0; b < points; ++b)
    if (b != a) out *= (t - time(b)) / (time(a) - time(b));
  return out;
}

// The same of that polynomial's slope there.
template <class TimeOf>
double lagrange_slope(std::size_t a, std::size_t points, double t, const TimeOf& time) {
  double out = 0;
  for (std::size_t c = 0; c < points; ++c) {
    if (c == a) continue;
    double product = 1 / (time(a) - time(c));
    for (std::size_t b = 0; b < points; ++b)
      if (b != a && b != c) product *= (t - time(b)) / (time(a) - time(b));
    out += product;
  }
  return out;
}

}  // namespace unfurl
