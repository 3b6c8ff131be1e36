// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Is what remains to the deployed pose a matter of drives alone, which no motion that they leave free
// changes?
bool drives_lead_to_deployed(const Trajectory& trajectory);

// The deployed pose to which drives lead, where constraints lose rank, at about the time `guess`, by steps of
// about the length h. Its time is the drives', and coordinates and rates there are smooth functions of time
// where they are none of what remains: which goes like the cube of the time left where a drive slows down to
// rest, and has no last part that a step could be solved to. So they are interpolated in time, from states
// before it and, before the next time `edge` at which a drive or load begins or ends, behind it; at the edge
// itself where the drives are at rest there. `fresh` makes the integrator. Nothing where it is not there.
struct DrivenDeployed {
  double guess, h, edge;
};
std::optional<State> locate_driven(const Trajectory& trajectory,
                                   const std::function<std::unique_ptr<Integrator>()>& fresh,
                                   const DrivenDeployed& where);

}  // namespace unfurl
