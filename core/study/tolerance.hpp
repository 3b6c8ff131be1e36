// SPDX-License-Identifier: BSD-3-Clause
// Accuracy as the input: stages and step are picked for a tolerance.
#pragma once

#include "core/simulate/simulation.hpp"

namespace unfurl {

// As simulate(), but where options.tolerance > 0 m, stages (of a method whose order depends on them) and step
// are picked first, so that the error of the node positions is estimated below it and judge() (accuracy.hpp)
// trusts all of the run. The estimate comes from
// two more solutions on other grids, with one stage more or else with smaller steps: the largest distance of
// a node at the times that they share with the run. It is in position_estimate of the result; where it is not
// below the tolerance, a warning says so: after a bounded amount of work the best that was found is the
// answer.
//
// The choice is the same on every machine: work is counted (a factorisation as much as eight solves), not
// timed.
//
// Before that options.model decides what is solved: "path" and, where it applies, "auto" take the path
// (path/path_run.hpp), whose answer is at round-off; a tolerance is compared with what the motion makes of
// that, as a second run shows that sets out from a start nudged by it. "sector" and, where there is no path
// or it does not keep the tolerance, "auto" solve one sector of a ring whose sectors are alike
// (path/sector.hpp). Throws PathRefused where "path" does not apply, SectorRefused where "sector" does not.
Simulation simulate_as_asked(const std::shared_ptr<const Model>& model, const SolverOptions& options,
                             const SimulationHooks& hooks = {});

}  // namespace unfurl
