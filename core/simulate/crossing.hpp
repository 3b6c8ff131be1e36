// SPDX-License-Identifier: BSD-3-Clause
// Where in a step the first of several margins falls below zero.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/system/state.hpp"

namespace unfurl {

// A state on the way of a step with the margins there, in units of what counts as zero: 1 and more is room,
// -1 and less is passed, between them lies what rounding leaves of zero.
struct Probe {
  double at = 0.0;  // how far into the step [s]
  State state = {};
  StepReport report = {};
  VectorXd margins = {};
  VectorXd rates = {};   // of the margins [1/s]; NaN: not known
  VectorXd forces = {};  // the sizes of those that are a force's; 0: they are none, or were not asked for
};

// Solves the step of this length from the same start; false where it cannot be solved.
using Solve = std::function<bool(double length, Probe& probe)>;

struct Crossing {
  Probe probe;                     // solved as a step of its own, up to the crossing
  std::vector<std::size_t> which;  // margins that are zero there and negative behind
  double later = 0.0;              // by less than that, where no step behind the probe can be solved [s]
  VectorXd left = {};              // of the forces, what the location may have left of zero
};

// `from`: the step's start; `to`: its end; `between`: margins at equal parts of the step, from some
// interpolant and NaN where they are not known (columns; a hint where a margin falls below zero and rises
// again inside). Everything else is found by steps of other lengths and not read off an interpolant, so that
// the state at the crossing is as accurate as any: a guess from the cubic through values and rates, then
// Newton's iteration or regula falsi (Illinois) inside a bracket. A margin that begins at zero crosses at
// once unless it rises first for at least a millionth of the step.
std::optional<Crossing> first_crossing(const Probe& from, const Probe& to, const MatrixXd& between,
                                       const Solve& solve);

}  // namespace unfurl
