// SPDX-License-Identifier: BSD-3-Clause
// The exact deployment of a scissor mast that is released at rest (geometry in scissor_mast.hpp).
#pragma once

#include <cmath>

#include "tests/support/one_freedom.hpp"

namespace unfurl::exact {

// A uniform rod of mass m whose ends move with va and vb has T = m/6 (va.va + va.vb + vb.vb). With height h
// and side w of a cell, a rod of cell i = 0..N-1 has ends that rise with i h' and (i+1) h'. Across the axis
//
//     planar:   they stand at x = 0 and x = w:                 va.va + va.vb + vb.vb = w'^2
//     n sides:  they move radially with R' = w' / (2 sin(pi/n)), at an angle of 2 pi/n:   R'^2 (2 + cos(2
//     pi/n))
//
// Because i^2 + i (i+1) + (i+1)^2 sums to N^3, the 2 n rods of all cells (n = 1: planar) have
//
//     T = (n m / 3) (N c w'^2 + N^3 h'^2),   c = 1 or (2 + cos(2 pi/n)) / (2 sin(pi/n))^2
//
// and a payload P, in equal shares on the corners of level N, P/2 (d w'^2 + N^2 h'^2) with d = 1/2 (planar:
// half of it stands still) or 1 / (2 sin(pi/n))^2. The tip force F does the work F N (h - h_0).
struct ScissorMast {
  int cells, sides;
  double l, rod_mass, fold_deg, deployed_deg, force, payload;

  double theta0() const { return fold_deg * M_PI / 180; }
  double deployed() const { return (fold_deg - deployed_deg) * M_PI / 180; }

  // x = theta_0 - theta, w = l sin(theta), h = l cos(theta).
  OneFreedom motion() const {
    const ScissorMast s = *this;
    const double k = 1 / (2 * std::sin(M_PI / sides)), N = cells;
    const double c = sides == 1 ? 1.0 : k * k * (2 + std::cos(2 * M_PI / sides)),
                 d = sides == 1 ? 0.5 : k * k;
    const double across = 2.0 / 3 * sides * rod_mass * N * c + payload * d;
    const double along = 2.0 / 3 * sides * rod_mass * N * N * N + payload * N * N;
    return {[=](double x) {
              const double w = s.l * std::cos(s.theta0() - x),
                           h = s.l * std::sin(s.theta0() - x);  // per theta'
              return across * w * w + along * h * h;
            },
            [=](double x) {  // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2)
              return s.force * N * s.l * 2 * std::sin(s.theta0() - 0.5 * x) * std::sin(0.5 * x);
            }};
  }
};

// The exact opening of a pantograph ring that is released at rest (geometry in scissor_ring.hpp). The
// corners' nodes move with R' = w' / (2 sin(pi/n)) radially and +-h'/2 along the axis; the ends of a rod at
// an angle of 2 pi/n and with opposite signs, so that the 2 n rods have
//
//     T = (n m / 3) (R'^2 (2 + cos(2 pi/n)) + h'^2 / 4)
//
// and a force f outward on each of the 2 n corner nodes does the work 2 n f (R - R_0).
struct ScissorRing {
  int n;
  double l, rod_mass, fold_deg, deployed_deg, force;

  double deployed() const { return (fold_deg - deployed_deg) * M_PI / 180; }

  // x = theta_0 - theta, w = l cos(theta), h = l sin(theta).
  OneFreedom motion() const {
    const ScissorRing s = *this;
    const double k = 1 / (2 * std::sin(M_PI / n)), theta0 = fold_deg * M_PI / 180,
                 c = 2 + std::cos(2 * M_PI / n);
    return {[=](double x) {
              const double R = k * s.l * std::sin(theta0 - x), h = s.l * std::cos(theta0 - x);  // per theta'
              return 2.0 / 3 * s.n * s.rod_mass * (c * R * R + 0.25 * h * h);
            },
            [=](double x) {  // cos b - cos a = 2 sin((a+b)/2) sin((a-b)/2)
              return 2 * s.n * s.force * k * s.l * 2 * std::sin(theta0 - 0.5 * x) * std::sin(0.5 * x);
            }};
  }
};

}  // namespace unfurl::exact
