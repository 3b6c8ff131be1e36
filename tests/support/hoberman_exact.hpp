// SPDX-License-Identifier: BSD-3-Clause
// The exact opening of a Hoberman ring that is released at rest (geometry in hoberman.hpp).
#pragma once

#include <cmath>

#include "tests/support/one_freedom.hpp"

namespace unfurl::exact {

// A bar from a pin (radius a, polar angle 0) to an end node (radius r, polar angle alpha/2) has
// T = m/6 (a'^2 + a' r' cos(alpha/2) + r'^2). Each unit has two bars to outer and two to inner nodes,
//
//     a = p sin(gamma) / sin(alpha/2),  r_+- = p sin(gamma +- alpha/2) / sin(alpha/2),  gamma = pi/2 - theta
//
// and the force f on its pin does the work f (a - a_0). x = theta_0 - theta = gamma - gamma_0.
struct Hoberman {
  int n;
  double p, bar_mass, fold_deg, deployed_deg, force;

  double deployed() const { return (fold_deg - deployed_deg) * M_PI / 180; }

  OneFreedom motion() const {
    const Hoberman s = *this;
    const double half = M_PI / n, scale = p / std::sin(half), gamma0 = (90 - fold_deg) * M_PI / 180;
    return {[=](double x) {
              const double g = gamma0 + x, a = scale * std::cos(g);  // per gamma'
              double sum = 0;
              for (const double r : {scale * std::cos(g + half), scale * std::cos(g - half)})
                sum += a * a + a * r * std::cos(half) + r * r;
              return 2.0 / 3 * s.n * s.bar_mass * sum;
            },
            [=](double x) {  // sin a - sin b = 2 cos((a+b)/2) sin((a-b)/2)
              return s.n * s.force * scale * 2 * std::cos(gamma0 + 0.5 * x) * std::sin(0.5 * x);
            }};
  }
};

}  // namespace unfurl::exact
