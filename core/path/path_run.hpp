// SPDX-License-Identifier: BSD-3-Clause
// A run of a structure of mobility one along its path.
#pragma once

#include "core/path/path.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

// As simulate(): states at the same grid of times and at the same events, from the path's scalar equation
// solved to round-off; options.method and what belongs to it play no part. Multipliers of the states are left
// to whoever wants forces, but at the deployed pose. Throws PathRefused, also where it is only on the way
// that something turns out to be beyond the path.
// nudge: the fastest node sets out so far along the path from where it stands [m], at the start.
Simulation simulate_on_path(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                            const SimulationHooks& hooks = {}, double nudge = 0.0);

}  // namespace unfurl
