// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/carried_sum.hpp"
#include "core/integrators/projection.hpp"
#include "core/integrators/stage_accelerations.hpp"
#include "core/system/state.hpp"
#include "core/system/system.hpp"

namespace unfurl {

// Gragg-Bulirsch-Stoer extrapolation on the index-1 equations, order 16: what references are solved with,
// because it shares neither discretisation nor order with any method of the table. (Hairer, Norsett, Wanner
// 1993, section II.9: modified midpoint rule with n = 2, 4, ..., 16 substeps, Aitken-Neville extrapolation in
// h^2.) Each basic step ends with a projection on the constraints and their rates. All of it is in increments
// from the step's start, whose sums carry what rounding takes from them: next to a dead centre errors of an
// ulp of the coordinates would grow as the motion does.
class Extrapolation {
 public:
  explicit Extrapolation(const System& system);
  // Advance by H [s]. False where the equations cannot be solved or a value is not finite.
  bool step(State& state, double H);

 private:
  static constexpr int columns = 8;
  bool midpoint(const State& state, double H, int n, VectorXd& out);
  bool rate(double t, const VectorXd& dy, VectorXd& f);

  System system_;  // follows the state that a step begins with
  StageAccelerations accelerations_;
  Index n_;
  Projection projection_;
  CarriedSum carried_;
  VectorXd y0_, y_, before_, now_, after_, f_, f0_, lambda_;  // all but y0_, y_: increments and rates
  VectorXd tableau_[columns];
};

}  // namespace unfurl
