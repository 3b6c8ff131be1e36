// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// The state at which the fold angle passes zero, found from solved states only. That pose is singular: a step
// that lands on it does not converge. So shortened steps are solved to several small fold angles on the near
// side, and time, coordinates, velocities and multipliers, which are smooth functions of sin(fold), are
// extrapolated from them to 0. The trajectory's last state must lie before the event, its next step (of size
// h) at or behind it.
std::optional<State> locate_deployed(const Trajectory& trajectory, Integrator& integrator, double h);

}  // namespace unfurl
