// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/integrators/integrator.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Is what remains to the deployed pose a matter of drives alone, which no motion that they leave free
// changes?
bool drives_lead_to_deployed(const Trajectory& trajectory);

// The next time at which something that constraints prescribe begins or ends.
double next_prescribed_edge(const Trajectory& trajectory);

// The deployed pose to which drives lead, where constraints lose rank, at about the time `guess`, by steps of
// about the length h. Its time is the drives', and coordinates and rates that drives alone move are smooth
// functions of time there, of none of what remains: which goes like the cube of the time left where a drive
// slows down to rest, and has no last part that a step could be solved to. So they are interpolated in time,
// from states before it and, before the next prescribed edge, behind it; at the edge itself where the drives
// are at rest there. What else moves goes its own way beside them. `fresh` makes the integrator. Nothing
// where it is not there.
struct DrivenDeployed {
  State state;
  double error = 0;  // how far it may be off, in a coordinate or, in a step, by a rate [m]
  // The nodes that drives hold there from then on: not in a pose that they lead through or away from.
  std::vector<int> held = {};
  // Where they come to rest in it: states on the way there, as long as the trajectory ends where it does.
  std::function<State(double t)> before = {};
};
std::optional<DrivenDeployed> locate_driven(const Trajectory& trajectory,
                                            const std::function<std::unique_ptr<Integrator>()>& fresh,
                                            double guess, double h);

}  // namespace unfurl
