// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The state in which `left`, > 0 at `from` and <= 0 after a step of size h, is zero: a step of the length
// that ends there, by regula falsi (Illinois). `solve` takes a step of a length from a state; nothing where
// it fails, as it does in singular poses, or where the step does not reach the zero.
std::optional<State> step_to_zero(const State& from, double h,
                                  const std::function<double(const State&)>& left,
                                  const std::function<bool(double length, State& state)>& solve);

// The same for what is left to the deployed value of a model's measure, less a margin; by a fresh integrator.
// Nothing where the structure has a fold angle instead.
std::optional<State> step_to_deployed(const Model& model, Integrator& integrator, const State& from, double h,
                                      double margin);

// The rate of Deployment::remaining at a state [1/s].
double remaining_rate(const Model& model, const State& state);

}  // namespace unfurl
