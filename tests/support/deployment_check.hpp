// SPDX-License-Identifier: BSD-3-Clause
// A run of one degree of freedom beside its exact solution.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/one_freedom.hpp"

namespace unfurl::testing {

inline double largest(const Series& series) {
  double m = 0;
  for (double v : series.values) m = std::max(m, std::abs(v));
  return m;
}

// The largest error of the fold angle [rad] over the states of a run released at rest, with x the fold angle
// that has gone by. The exact time of an angle, times the rate, is better conditioned than the angle at a
// time. States in which the angle has hardly moved (x < 1e-6) hold too few digits of x and are left out.
inline double fold_error(const exact::OneFreedom& exact, const Diagnostics& d, std::size_t stride) {
  const auto& theta = d.at("fold_angle_rad").values;
  double worst = 0;
  for (std::size_t i = stride; i < d.t.size(); i += stride) {
    const double x = theta[0] - theta[i];
    if (x > 1e-6) worst = std::max(worst, std::abs(exact.time(x) - d.t[i]) * exact.rate(x));
  }
  return worst;
}

}  // namespace unfurl::testing
