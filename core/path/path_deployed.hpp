// SPDX-License-Identifier: BSD-3-Clause
// Multipliers in the deployed pose of a motion along a path.
#pragma once

#include <functional>

#include "core/path/path_watch.hpp"

namespace unfurl {

// The deployed pose may be singular: multipliers are smooth functions of the sine of the fold angle, or of
// time where the motion comes to rest there, and extrapolated to it from poses before it, as far out as the
// time loop has them. `state`: that of the model at a time, place and speed; `followed`: its equations, near
// the angles of the last state.
void limit_multipliers(System followed, const PathWatch& watch, const PathMotion& motion, double step,
                       const std::function<State(double t, double s, double v)>& state, State& event);

}  // namespace unfurl
