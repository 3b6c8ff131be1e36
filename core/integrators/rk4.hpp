// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/integrator.hpp"
#include "core/integrators/stage_accelerations.hpp"

namespace unfurl {

// The classical Runge-Kutta method on the index-1 equations, z' = w, w' = a(t, z, w): stages at 0, h/2, h/2,
// h with weights 1/6, 1/3, 1/3, 1/6. Nothing holds the constraints: they drift, but where redundant rows
// contradict each other beside them (StageAccelerations::settle).
class RungeKutta4 : public Integrator {
 public:
  explicit RungeKutta4(const System& system, double baumgarte_rate = 0.0);
  StepReport step(State& state, double h) final;
  void restart() override { accelerations_.restart(); }
  void expect_contradictions() override { accelerations_.expect_contradictions(); }

 protected:
  // Called with the end of a step before it is accepted: a method may move it. False: the step has failed.
  virtual bool settle(const State& /*from*/, double t, VectorXd& z, VectorXd& w, StepReport& /*report*/) {
    accelerations_.settle(t, z, w);
    return true;
  }
  const System& system_;

 private:
  StageAccelerations accelerations_;
  VectorXd z_, w_, q_, lambda_, phi_;
  VectorXd dz_[4], dw_[4];
};

Claims rk4_claims(const SolverOptions& options);
std::unique_ptr<Integrator> make_rk4(const System& system, const SolverOptions& options);

}  // namespace unfurl
