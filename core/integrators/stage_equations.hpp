#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "core/integrators/galerkin.hpp"
#include "core/model/system.hpp"

namespace unfurl {

// The level of the constraints (in units of their noise, see below) at which the iteration of a step ends.
inline constexpr double constraint_level_wanted = 2.0;

// What rounding the coordinates, as large as `reach`, leaves of a constraint of this length [m].
inline double constraint_noise(double length, double reach) {
  return 2 * std::numeric_limits<double>::epsilon() * std::max(length, reach);
}

// Unknowns and residuals of one variational step; allocated once per model.
//   dX [nz x s-1]: increments of the nodes 2..s from the step's start;  lambda [m x s-1]: multipliers of
//   nodes 1..s-1 momentum [nz x s-1]: D_k S (+ p_0 for k = 1), kg m/s;  phi [m x s-1]: Phi(Q_j), j = 2..s, m
// With constraints at the ends only, lambda has its first column and phi its last one in use; the rest stays
// zero.
class StageEquations {
 public:
  StageEquations(const System& system, const GalerkinCoefficients& coefficients, bool at_ends);

  void start(double t, const ConstVec& z0, const ConstVec& w0, double h);  // w0: p_0 = M w0
  void place_nodes();                                                      // Q of the present dX
  void evaluate();               // residuals of the present dX, lambda
  void end_momentum(MutVec p1);  // p_1 without the share of lambda_s

  // Residuals in units of what round-off leaves of them: 1 is as small as they get, give or take.
  double momentum_level() const { return momentum_level_; }
  double constraint_level() const { return constraint_level_; }
  double level() const { return std::max(momentum_level_, constraint_level_); }

  // What rounding the coordinates leaves of row r of Phi [m]. A residual below it carries no information; in
  // redundant rows it would be answered with multipliers of size (residual / regularisation).
  double constraint_noise(Index r) const {
    return unfurl::constraint_noise(system.constraint_lengths()[r], reach_);
  }

  double multiplier_weight(int k) const;           // b_k, or 1/2 for the ends variant; k = 0..s-1
  ConstVec node(int k) const { return Q.col(k); }  // node coordinates at node k

  const System& system;
  const GalerkinCoefficients& c;
  const bool at_ends;
  double t = 0, h = 0;
  VectorXd z0, p0;
  MatrixXd dX, lambda, momentum, phi;
  MatrixXd Q;  // [3 nodes x s]

 private:
  static constexpr double ulp = std::numeric_limits<double>::epsilon();
  void add_forces(int k, MutVec f);
  void measure();

  MatrixXd MdX_, force_;  // M dX_j; node forces at the quadrature times or (constant) one column
  VectorXd z_, f_, q_tau_, v_tau_;
  double momentum_level_ = 0, constraint_level_ = 0;
  double force_scale_ = 0, reach_ = 0;
};

}  // namespace unfurl
