// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/math/quadrature.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// What a motion D from a pose z_0 changes of the constraints,
//
//     Phi(z_0 + D, t) - Phi(z_0, t_0) = (integral of G(z_0 + sigma D) over 0 <= sigma <= 1) D - (g(t) -
//     g(t_0))
//
// by three Gauss points, which are exact for every constraint that is a polynomial of degree six or less.
// Nothing cancels in the product: its round-off is relative to D, that of Phi itself to the coordinates,
// which next to a dead centre are 1e8 times larger. Of an angle that turns by a rad they miss c a^7, which no
// later step asks for: what they miss beyond round-off is taken from what its kind offers.
class ConstraintIncrement {
 public:
  explicit ConstraintIncrement(const System& system);
  void start(double t, const ConstVec& q0);  // q0: node coordinates
  void evaluate(double t, const ConstVec& D, MutVec change);

 private:
  void take_what_points_miss();

  const System& system_;
  const Quadrature gauss_ = gauss_legendre(3);
  SparseRows G_;
  std::vector<double> scratch_;
  double t0_ = 0;
  VectorXd q0_, pose_, move_, sum_, exact_, target0_, target_;
};

}  // namespace unfurl
