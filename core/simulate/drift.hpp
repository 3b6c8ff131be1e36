// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/index1.hpp"

namespace unfurl {

// What is too short for a step of a method, by the acceleration in its middle: a load that changes evenly
// gives all of its impulse.
inline StepReport drift(const System& system, State& state, double h) {
  State middle = state;
  middle.t += 0.5 * h;
  middle.z += 0.5 * h * state.w;
  VectorXd acceleration(state.w.size());
  const System followed = system.at(state);
  Index1 index1(followed);
  if (!index1.evaluate(middle, acceleration, middle.lambda)) acceleration.setZero();
  state.t += h;
  state.z += h * state.w + 0.5 * h * h * acceleration;
  state.w += h * acceleration;
  return {};
}

}  // namespace unfurl
