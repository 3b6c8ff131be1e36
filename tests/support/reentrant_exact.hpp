// SPDX-License-Identifier: BSD-3-Clause
// The exact motion of a re-entrant sheet that is pulled from rest (geometry in reentrant_sheet.hpp).
#pragma once

#include <array>
#include <cmath>
#include <initializer_list>

#include "tests/support/one_freedom.hpp"

namespace unfurl::exact {

// Per unit of theta' (x = theta_0 - theta counts the other way, which squares remove) a node of zigzag j,
// column i moves
//
//     x' = -(i - c) l sin(theta),   z' = l cos(theta) (up - j + (r - 1)/2),  up = 1 on its upper side, else 0
//
// because zigzag j stands at j (h - l sin(theta)) and the sheet is held at its middle height, r (h - l sin)/2
// + l sin/2. Each rod has m/6 (va.va + va.vb + vb.vb). The pull f on either side does the work 2 f c l (cos -
// cos_0).
struct ReentrantSheet {
  int r, c;  // rows, columns
  double l, h, mass_per_length, fold_deg, deployed_deg, force;

  double deployed() const { return (fold_deg - deployed_deg) * M_PI / 180; }

  std::array<double, 2> velocity(int j, int i, double theta) const {
    const int up = (i + j) % 2;
    return {-(i - c) * l * std::sin(theta), l * std::cos(theta) * (up - j + 0.5 * (r - 1))};
  }
  double rod(double mass, std::array<double, 2> a, std::array<double, 2> b) const {  // twice its energy
    return mass / 3 * (a[0] * a[0] + a[1] * a[1] + a[0] * b[0] + a[1] * b[1] + b[0] * b[0] + b[1] * b[1]);
  }
  double inertia(double theta) const {
    double sum = 0;
    for (int j = 0; j <= r; ++j)
      for (int i = 0; i <= 2 * c; ++i) {
        if (i < 2 * c) sum += rod(mass_per_length * l, velocity(j, i, theta), velocity(j, i + 1, theta));
        if (j < r && (i + j) % 2 == 0)
          sum += rod(mass_per_length * h, velocity(j, i, theta), velocity(j + 1, i, theta));
      }
    return sum;
  }
  OneFreedom motion() const {
    const ReentrantSheet s = *this;
    const double theta0 = fold_deg * M_PI / 180;
    return {
        [=](double x) { return s.inertia(theta0 - x); },
        [=](double x) { return 4 * s.force * s.c * s.l * std::sin(theta0 - 0.5 * x) * std::sin(0.5 * x); }};
  }
  double poisson(double theta) const {
    return -l * std::cos(theta) * std::cos(theta) / (std::sin(theta) * (h - l * std::sin(theta)));
  }
};

}  // namespace unfurl::exact
