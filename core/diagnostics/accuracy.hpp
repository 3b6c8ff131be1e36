#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// What a finished run says against itself: an energy balance or a constraint error too large for the result
// to be trusted. Each text names the size and the cure; empty where nothing is wrong.
std::vector<std::string> accuracy_warnings(const Diagnostics& diagnostics);

}  // namespace unfurl
