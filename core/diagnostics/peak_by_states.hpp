// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/diagnostics/peaks.hpp"

namespace unfurl {

// Next to a singular pose states within a step, whose errors are beyond round-off, may have forces of their
// own, some 1e-3 of what they are. Where the six known states around what was found there lie on one
// polynomial, x(t) at the run's states, and it lies above that, by less than a hundredth, the top of the
// polynomial between the middle four; else what was found, as a peak that is narrower than a step.
PeakInMotion by_states(const Simulation& run, const std::vector<double>& x, const PeakInMotion& found);

}  // namespace unfurl
