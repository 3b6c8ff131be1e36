// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace unfurl::exact {

// Gauss-Legendre quadrature with 10 points of f from lo to hi (Abramowitz and Stegun, table 25.4).
template <class Function>
double gauss_panel(const Function& f, double lo, double hi) {
  constexpr double x[5] = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244, 0.8650633666889845,
                           0.9739065285171717};
  constexpr double w[5] = {0.2955242247147529, 0.2692667193099963, 0.2190863625159820, 0.1494513491505806,
                           0.0666713443086881};
  const double m = 0.5 * (lo + hi), r = 0.5 * (hi - lo);
  double sum = 0;
  for (int i = 0; i < 5; ++i) sum += w[i] * (f(m - r * x[i]) + f(m + r * x[i]));
  return r * sum;
}

}  // namespace unfurl::exact
