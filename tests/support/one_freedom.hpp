// SPDX-License-Identifier: BSD-3-Clause
// Released at rest, a mechanism of one degree of freedom whose loads depend on its pose alone moves as energy
// tells.
#pragma once

#include <cmath>
#include <functional>

#include "tests/support/gauss_panel.hpp"

namespace unfurl::exact {

// The coordinate x >= 0 counts from the pose of release. With the kinetic energy I(x) x'^2 / 2 and the work
// W(x) done since the release
//
//     x'^2 = 2 W / I,      t(x) = integral_0^x sqrt(I / (2 W)) dx = integral_0^sqrt(x) 2 u sqrt(I / (2 W))
//     du,  x = u^2
//
// where the substitution removes the singularity at rest (W ~ x there). W must be free of cancellation near x
// = 0.
struct OneFreedom {
  std::function<double(double)> inertia;  // I(x)
  std::function<double(double)> work;     // W(x)

  double rate(double x) const { return std::sqrt(2 * work(x) / inertia(x)); }

  // Composite Gauss-Legendre quadrature with 10 points, panels halved until nothing changes above round-off.
  double time(double x) const {
    const auto integrand = [&](double u) { return 2 * u / rate(u * u); };
    const double end = std::sqrt(x);
    double previous = -1, sum = 0;
    for (int panels = 4; panels <= 4096; panels *= 2) {
      sum = 0;
      for (int p = 0; p < panels; ++p)
        sum += gauss_panel(integrand, end * p / panels, end * (p + 1) / panels);
      if (std::abs(sum - previous) < 2e-15 * sum) break;
      previous = sum;
    }
    return sum;
  }
};

}  // namespace unfurl::exact
