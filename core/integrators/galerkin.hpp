// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "core/math/barycentric.hpp"
#include "core/math/quadrature.hpp"
#include "core/math/types.hpp"

namespace unfurl {

// The coefficients of a Galerkin variational step with s control times c_1 = 0 < ... < c_s = 1 on the unit
// interval.
struct GalerkinCoefficients {
  GalerkinCoefficients(std::string_view family, int s);

  int s;
  Barycentric basis;      // l_k on the control times
  VectorXd b;             // b_k = integral of l_k
  MatrixXd K;             // K_ki = integral of l_k' l_i'  [s x s]
  MatrixXd C, C_inverse;  // K_kj for k = 1..s-1, j = 2..s: the kinetic terms of the stage equations
  // Where forces that vary are taken: s - 1 Gauss points tau_j, w_j, and l_k(tau_j), l_k'(tau_j) there
  // [s x s-1]. The scheme without constraints is then Gauss collocation: stable, with springs and dampers of
  // any stiffness, and of order 2 s - 2 all the same. Elastic rows with multipliers of their own fit here.
  VectorXd tau, weight;
  MatrixXd value, slope;
  VectorXd tau_to_end;  // values at tau_j, by their polynomial, to its value at the step's end
  MatrixXd
      extrapolation;  // row i: increments of the polynomial of a step, prolonged to c_{i+2} of the next step

  // Row i: l_j(1 + c_{i+2} ratio) - l_j(1), j = 2..s (the increment of Q_1 is zero). [s-1 x s-1]
  void extrapolate(double ratio, MatrixXd& out) const;

 private:
  void take(const Quadrature& rule);
};

}  // namespace unfurl
