// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

constexpr double smallest_share = 1e-5;  // of the largest step: slower than this, a run is better refused

}  // namespace

StepControl::StepControl(const Structure& structure, const System& system, const SolverOptions& options)
    : structure_(structure),
      system_(system),
      index1_(system_),
      largest_(options.step),
      turn_(options.turn),
      acceleration_(system.solved_coordinates()),
      lambda_(system.constraints()),
      v_(system.coordinates()) {}

double StepControl::density(const State& state) {
  system_.follow(state);
  system_.expand_rate(state.w, v_);
  double omega = 0;
  for (const Rod& rod : structure_.rods)
    omega = std::max(omega, (v_.segment<3>(3 * rod.b) - v_.segment<3>(3 * rod.a)).norm() / rod.length);
  double change = 0;
  if (index1_.evaluate(state, acceleration_, lambda_)) {
    const double r0 = turn_ / largest_;
    const double w = std::sqrt(2 * system_.kinetic_energy(state.w));
    const double a = std::sqrt(2 * system_.kinetic_energy(acceleration_));
    if (a > 0) change = a / (w + a / r0);
  }
  const double x = largest_ * (omega + change) / turn_;
  return std::sqrt(1 + x * x);
}

double StepControl::next(const State& state) {
  const double wanted = largest_ / density(state);
  const double h = previous_ > 0 ? wanted * wanted / previous_ : wanted;
  return previous_ = std::clamp(h, smallest_share * largest_, 1.5 * largest_);
}

}  // namespace unfurl
