// SPDX-License-Identifier: BSD-3-Clause
// What acts to one side only, at the end of that side.
#pragma once

#include <string>
#include <vector>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Of the pose of a state: stops and cables that are touched, or exactly taut, and do not hold, and cables and
// springs that pull only whose ends are just their free length apart. Small motions about the pose go one way
// with them and the other way without, so that they have no stiffness and no frequency.
std::vector<std::string> touched_limits(const Model& model, const State& pose);

}  // namespace unfurl
