// SPDX-License-Identifier: BSD-3-Clause
// How far a run got that ended before the structure was deployed.
#pragma once

#include <string>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// "32.4 % deployed when end_time = 1 s was reached"; empty where the structure does not deploy, has done so,
// or the run ended in another way.
std::string ending_note(const Simulation& run, const Diagnostics& diagnostics);

}  // namespace unfurl
