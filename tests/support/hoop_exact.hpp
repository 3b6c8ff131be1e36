// SPDX-License-Identifier: BSD-3-Clause
// The exact deployment of a hoop that is released at rest: one degree of freedom, by energy (see physics of
// the ring in hoop.hpp for the geometry).
#pragma once

#include <cmath>

#include "tests/support/gauss_panel.hpp"

namespace unfurl::exact {

// Per unit, with theta the fold angle and f the force on each hinge,
//     l1^2 theta'^2 G(theta) = 2 f l1 (sin theta_0 - sin theta)
//     G = (2/3) m1 [k^2 (1 + 2 cos^2(pi/n)) sin^2 theta + cos^2 theta] + (1/2) m2 k^2 sin^2 theta,  k = 1 /
//     sin(pi/n)
struct Hoop {
  int n = 6;
  double l1 = 3.0, l2 = 1.2, density = 3000.0, area = 9e-4, fold_angle_deg = 89.34053637766085, f = 200.0;

  double theta0() const { return fold_angle_deg * M_PI / 180.0; }
  double e0() const { return (90.0 - fold_angle_deg) * M_PI / 180.0; }  // keeps its digits near 90 degrees
  double G(double theta) const {
    const double k = 1 / std::sin(M_PI / n), c = std::cos(M_PI / n), s = std::sin(theta);
    const double m1 = density * area * l1, m2 = density * area * l2;
    return 2.0 / 3.0 * m1 * (k * k * (1 + 2 * c * c) * s * s + std::cos(theta) * std::cos(theta)) +
           0.5 * m2 * k * k * s * s;
  }
  double rate(double theta) const {  // theta' < 0 [rad/s]
    return -std::sqrt(2 * f * (std::sin(theta0()) - std::sin(theta)) / (l1 * G(theta)));
  }

  // t(theta): theta = theta_0 - u^2 removes the end singularity; dt = 2 u du / |theta'|. With
  // sin a - sin b = 2 cos((a+b)/2) sin((a-b)/2) nothing cancels near theta_0. Tanh-sinh free: composite
  // Gauss-Legendre with 10 points on panels that shrink towards u = 0, where near dead centre the integrand
  // varies on the scale of 90 deg - theta_0; doubled until nothing changes above round-off.
  double time(double theta) const {
    const auto integrand = [&](double u) {
      const double difference =
          2 * std::sin(e0() + 0.5 * u * u) * std::sin(0.5 * u * u);  // sin theta0 - sin theta
      return 2 * u * std::sqrt(l1 * G(theta0() - u * u) / (2 * f * difference));
    };
    const double end = std::sqrt(theta0() - theta);
    double previous = -1, sum = 0;
    for (int panels = 32; panels <= 4096; panels *= 2) {
      sum = 0;
      double hi = end;
      for (int p = 0; p < panels; ++p) {
        const double lo = p + 1 == panels ? 0.0 : hi * std::pow(1e-7, 1.0 / panels);
        sum += gauss_panel(integrand, lo, hi);
        hi = lo;
      }
      if (std::abs(sum - previous) < 1e-15 * sum) break;
      previous = sum;
    }
    return sum;
  }

  // theta(t) by Newton on t(theta), started from a bisection.
  double angle(double t) const {
    double lo = 0, hi = theta0();
    if (t <= 0) return hi;
    for (int i = 0; i < 30; ++i) {
      const double mid = 0.5 * (lo + hi);
      (time(mid) > t ? lo : hi) = mid;
    }
    double theta = 0.5 * (lo + hi);
    for (int i = 0; i < 3; ++i) theta -= (time(theta) - t) * rate(theta);
    return theta;
  }
};

}  // namespace unfurl::exact
