// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "core/system/state.hpp"

namespace unfurl {

// The state in which `left`, > 0 at `from` and <= 0 after a step of size h, is zero: a step of the length
// that ends there, by regula falsi (Illinois). `solve` takes a step of a length from a state; nothing where
// it fails, as it does in singular poses, or where the step does not reach the zero.
std::optional<State> step_to_zero(const State& from, double h,
                                  const std::function<double(const State&)>& left,
                                  const std::function<bool(double length, State& state)>& solve);

}  // namespace unfurl
