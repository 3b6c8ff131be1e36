// SPDX-License-Identifier: BSD-3-Clause
// The least of a function between two places, of one that falls and then rises there.
#pragma once

#include <utility>

namespace unfurl {

// Where it is least, to a share of 0.618^cuts of the way between a and b: 60 cuts are rounding. A value next
// to a least one is that to the square of the share.
template <class Function>
double golden_section(const Function& f, double a, double b, int cuts) {
  constexpr double golden = 0.6180339887498949;
  double x = b - golden * (b - a), y = a + golden * (b - a);
  double at_x = f(x), at_y = f(y);
  for (int it = 0; it < cuts; ++it) {
    // What is kept drifts by 2.6 times its error a cut: after some 40 its order may be lost.
    if (!(a < x && x < y && y < b)) {
      x = b - golden * (b - a), y = a + golden * (b - a);
      at_x = f(x), at_y = f(y);
    }
    if (at_x < at_y) {
      b = std::exchange(y, x);
      at_y = at_x;
      x = b - golden * (b - a);
      at_x = f(x);
    } else {
      a = std::exchange(x, y);
      at_x = at_y;
      y = a + golden * (b - a);
      at_y = f(y);
    }
  }
  return 0.5 * (a + b);
}

}  // namespace unfurl
