// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/index1.hpp"

namespace unfurl {

// What is too short for a step of a method: two terms of Taylor's series.
inline StepReport drift(const System& system, State& state, double h) {
  VectorXd acceleration(state.w.size());
  VectorXd lambda = state.lambda;
  const System followed = system.at(state);
  Index1 index1(followed);
  if (!index1.evaluate(state, acceleration, lambda)) acceleration.setZero();
  state.t += h;
  state.z += h * state.w + 0.5 * h * h * acceleration;
  state.w += h * acceleration;
  return {};
}

}  // namespace unfurl
