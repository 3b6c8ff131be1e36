// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/forces/force.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

// Friction between a cable and what it wraps around, without a state of its own. In spans i = 0 ... k - 1 of
// lengths l_i the tensions are N c_i: N by the law of the whole cable, and pulley j, between the spans j - 1
// and j, takes its part (the capstan of Euler and Eytelwein),
//
//     c_0 = 1,   c_j = c_{j-1} exp(-mu beta_j p(x_j)),   x_j = u_j / u_c,   u_j = -(l_j' + ... + l_{k-1}')
//
// beta_j the wrap angle and u_j the speed at which the cable runs over it towards the first node, at which it
// is drawn in and where it stretches. p is the sign where |x| >= 1; slower it creeps,
//
//     p(x) = (35 x - 35 x^3 + 21 x^5 - 5 x^7) / 16,   p' = 35 (1 - x^2)^3 / 16
//
// with tensions anywhere between those that slip. sum_i N c_i l_i' = N S' + sum_j N (c_{j-1} - c_j) u_j: no
// term of the last sum, what the pulleys take, is negative. By small changes
//
//     dc_i = c_i (-mu sum_{j <= i} p_j dbeta_j + sum_m A_min(i,m) dl_m'),   A_i = mu sum_{j <= i} beta_j p'_j
//     / u_c
class Pulleys {
 public:
  static bool rubs(const Force& force) { return force.kind == "cable" && force.kinetic > 0; }
  // cable: its measure is a path, of which terms that are no lengths (a drum) go with the first span.
  Pulleys(const Force& cable, const Deployment& deployment);

  // The gradient of S becomes sum_i c_i grad l_i. v: node velocities [m/s].
  void weigh(const double* v, double* gradient) const;
  // Of the force -N sum_i c_i grad l_i where N stays.
  void derivatives(const double* q, const double* v, double tension, ForceDerivative& by_q,
                   ForceDerivative& by_v) const;

 private:
  struct Span {
    MeasureFunction length;
    Eigen::Index first;  // of its entries in the gradient
  };
  struct Pass {
    double c = 1, wrap = 0, share = 0, slope = 0;  // c_i, and of the pulley before it: beta, p, p'
  };
  std::vector<Pass> passes(const double* v, const double* gradient) const;
  // mu p dbeta of the pulley before a span by the coordinates of both, as entries of the gradient.
  void add_wrap(std::size_t span, const Pass& pass, const double* q, const double* gradient,
                VectorXd& out) const;

  std::vector<Span> spans_;
  std::vector<int> stencil_;
  double friction_, creep_;
};

}  // namespace unfurl
