// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "core/diagnostics/peaks.hpp"

namespace unfurl {

// The largest value of sign * E of a drive's column NAME.energy_J, of which NAME.power_W is the derivative,
// within the steps of a run: where the power changes its sign, that of the cubic with both at the step's
// ends, of order 4. Not where the power jumps, between whose values the energy does not follow: it is largest
// at a state then. `joined`: does a step lead from this state to that? `best`: that of the states.
PeakInMotion top_of_energy(const Trajectory& run, const Diagnostics& d, const Series& energy, double sign,
                           bool (*joined)(const Trajectory&, std::size_t, std::size_t), PeakInMotion best);

}  // namespace unfurl
