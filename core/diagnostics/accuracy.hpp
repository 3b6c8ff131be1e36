#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// What a finished run says against itself: an energy balance or a constraint error too large for the result
// to be trusted. Each text names the size and the cure; empty where nothing is wrong.
std::vector<std::string> accuracy_warnings(const Diagnostics& diagnostics);

// The constraint error relative to rod length up to which a step's Newton iteration goes on: some units of
// the round-off of coordinates, which are as large as the structure; 0 for methods without one. Taken at the
// end of the run, for the shortest rod or other length.
double constraint_tolerance(const Simulation& run);

}  // namespace unfurl
