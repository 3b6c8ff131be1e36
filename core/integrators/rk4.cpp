// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/rk4.hpp"

namespace unfurl {

RungeKutta4::RungeKutta4(const System& system, double baumgarte_rate)
    : system_(system),
      accelerations_(system),
      q_(system.coordinates()),
      lambda_(system.constraints()),
      phi_(system.constraints()) {
  accelerations_.stabilise(baumgarte_rate);
  for (VectorXd& k : dz_) k.setZero(system.solved_coordinates());
  for (VectorXd& k : dw_) k.setZero(system.solved_coordinates());
  z_.setZero(system.solved_coordinates());
  w_.setZero(system.solved_coordinates());
}

StepReport RungeKutta4::step(State& state, double h) {
  StepReport report;
  accelerations_.begin(state);
  report.contradictions = accelerations_.known();
  static constexpr double at[4] = {0.0, 0.5, 0.5, 1.0};
  for (int i = 0; i < 4; ++i) {
    z_ = state.z;
    w_ = state.w;
    if (i > 0) {
      z_ += at[i] * h * dz_[i - 1];
      w_ += at[i] * h * dw_[i - 1];
    }
    dz_[i] = w_;
    ++report.factorisations;
    ++report.right_hand_sides;
    if (!accelerations_.evaluate(state.t + at[i] * h, z_, w_, dw_[i], lambda_)) {
      report.status = StepStatus::not_finite;
      return report;
    }
    if (accelerations_.seen()) return step(state, h);
  }
  z_ = state.z + h / 6.0 * (dz_[0] + 2.0 * dz_[1] + 2.0 * dz_[2] + dz_[3]);
  w_ = state.w + h / 6.0 * (dw_[0] + 2.0 * dw_[1] + 2.0 * dw_[2] + dw_[3]);
  if (!settle(state, state.t + h, z_, w_, report)) {
    if (report.ok()) report.status = StepStatus::stalled;
    return report;
  }
  system_.expand(z_, q_);
  system_.constraint(state.t + h, q_, phi_);
  report.constraint_norm = phi_.size() ? phi_.lpNorm<Eigen::Infinity>() : 0.0;
  if (!z_.allFinite() || !w_.allFinite()) {
    report.status = StepStatus::not_finite;
    return report;
  }
  state.t += h;
  state.z = z_;
  state.w = w_;
  state.lambda = lambda_;
  return report;
}

Claims rk4_claims(const SolverOptions&) {
  return {.order = 4};
}

std::unique_ptr<Integrator> make_rk4(const System& system, const SolverOptions&) {
  return std::make_unique<RungeKutta4>(system);
}

}  // namespace unfurl
