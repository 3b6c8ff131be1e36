// SPDX-License-Identifier: BSD-3-Clause
// What a run says of itself besides warnings.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// "32.4 % deployed when end_time = 1 s was reached"; empty where the structure does not deploy, has done so,
// or the run ended in another way.
std::string ending_note(const Simulation& run, const Diagnostics& diagnostics);

// That, and that singular poses were not looked for where the structure is too large for it.
std::vector<std::string> notes_of(const Simulation& run, const Diagnostics& diagnostics);

}  // namespace unfurl
