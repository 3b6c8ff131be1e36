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

}  // namespace unfurl::exact
