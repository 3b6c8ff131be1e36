// SPDX-License-Identifier: BSD-3-Clause
// Motion of one coordinate, s'' = Q(s, s', t), to round-off.
//
// Collocation at the n = 12 Gauss points of a step: s'' is a polynomial of degree 11 there that fulfils the
// equation, and the step's end is right to the order 24 (Hairer, Norsett, Wanner 1993, II.7). As collocation
// it is stable for springs and dampers of any stiffness. The step is as long as the last two Legendre
// coefficients of s'' allow, so that the polynomials of a step tell what is between as well as its end.
#pragma once

#include <array>

#include "core/math/types.hpp"

namespace unfurl {

class ScalarLaw {
 public:
  struct Value {
    double Q = 0.0, by_s = 0.0, by_v = 0.0;
    double scale = 0.0;  // what Q is the sum of: its round-off is some 1e-16 of that
    // What more it may be off by: steps resolve no less, and go through jumps of that size.
    double noise = 0.0;
  };
  virtual ~ScalarLaw() = default;
  virtual Value at(double s, double v, double t) const = 0;  // NaN where s is out of reach
};

class ScalarStep {
 public:
  static constexpr int points = 12;

  double t0 = 0.0, h = 0.0, s0 = 0.0, v0 = 0.0;
  std::array<double, points> c{};  // Legendre coefficients of s'' over the step
  int iterations = 0;

  double end() const { return t0 + h; }
  void at(double t, double& s, double& v) const;  // within the step
};

// One step from (t, s, v), at most until `latest`; h is the length tried and comes out as that to try next.
// False where none can be solved that is longer than rounding.
bool scalar_step(const ScalarLaw& law, double t, double s, double v, double latest, double& h,
                 ScalarStep& step);

}  // namespace unfurl
