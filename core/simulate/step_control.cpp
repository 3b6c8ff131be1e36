// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

constexpr double smallest_share = 1e-5;  // of the largest step: slower than this, a run is better refused
// Steps that alternate about what is wanted by more than this factor do so to the end: a start anew.
constexpr double out_of_step = 1.5;

}  // namespace

StepControl::StepControl(const Structure& structure, const System& system, const SolverOptions& options)
    : structure_(structure),
      system_(system),
      index1_(system_),
      largest_(options.step),
      turn_(options.turn),
      acceleration_(system.solved_coordinates()),
      lambda_(system.constraints()),
      q_(system.coordinates()),
      v_(system.coordinates()),
      a_(system.coordinates()) {}

double StepControl::density(const State& state) {
  system_.follow(state);
  system_.expand(state.z, q_);
  system_.expand_rate(state.w, v_);
  known_ = index1_.evaluate(state, acceleration_, lambda_);
  if (known_)
    system_.expand_rate(acceleration_, a_);
  else
    a_.setZero();
  double omega = 0, change = 0;
  for (const Rod& rod : structure_.rods) {
    const auto of = [&](const VectorXd& x) -> Vec3 {
      return x.segment<3>(3 * rod.b) - x.segment<3>(3 * rod.a);
    };
    const double rate = of(v_).norm() / rod.length;
    const double bend = of(q_).normalized().cross(of(a_)).norm() / rod.length;
    omega = std::max(omega, 0.5 * (rate + std::sqrt(rate * rate + 2 * bend * turn_)));
  }
  if (known_) {
    const double r0 = turn_ / largest_;
    const double w = std::sqrt(2 * system_.kinetic_energy(state.w));
    const double a = std::sqrt(2 * system_.kinetic_energy(acceleration_));
    if (a > 0) change = a / (w + a / r0);
  }
  const double x = largest_ * (omega + change) / turn_;
  return std::sqrt(1 + x * x);
}

// Of a step that others follow, each as long as the geometric mean of what is wanted at its ends: by where
// the motion leads to second order.
double StepControl::start(const State& state) {
  const double wanted = largest_ / density(state);
  if (!known_) return wanted;
  const VectorXd acceleration = acceleration_;
  double h = wanted;
  for (int round = 0; round < 3; ++round) {
    State to = state;
    to.t += h;
    to.z += h * state.w + 0.5 * h * h * acceleration;
    to.w += h * acceleration;
    h = std::sqrt(wanted * (largest_ / density(to)));
  }
  return h;
}

double StepControl::next(const State& state) {
  const double wanted = largest_ / density(state);
  double h = previous_ > 0 ? wanted * wanted / previous_ : 0.0;
  if (!(h <= out_of_step * wanted && wanted <= out_of_step * h)) h = start(state);
  return previous_ = std::clamp(h, smallest_share * largest_, largest_);
}

}  // namespace unfurl
