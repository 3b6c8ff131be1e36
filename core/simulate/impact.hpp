// SPDX-License-Identifier: BSD-3-Clause
// What stops do that are approached: impulses, all at once or one blow after the other.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/simulate/one_sided.hpp"
#include "core/simulate/push_responses.hpp"

namespace unfurl {

// Of the rows of `responses`.
struct Impacts {
  std::vector<bool> struck;   // was approached, faster than what counts as zero
  VectorXd lost;              // kinetic energy, of those [J]
  Index pushed_against = -1;  // the row of a stop that has no answer: a drive moves what meets it; -1: none
};

// The stops among `sides_of` (of each row) that rates approach, in a state whose rates then are those behind
// the impacts, by the law of mode_change.hpp. Where that law pushes a stop that is being left (a light body
// that a wall throws back at a heavy one) it could give energy: what is approached acts first then, and what
// is met by that in the next blow, until nothing is approached. `crossed`: rows whose event this is. `rests`:
// does an impact on a side with this approach speed end in rest?
Impacts strike_stops(const OneSided& sides, const std::vector<std::size_t>& sides_of,
                     const std::vector<bool>& crossed, const PushResponses& responses, const MatrixXd& D,
                     const std::function<bool(std::size_t, double)>& rests, State& state);

// "a drive pushes against the stop NAME": of stop i whose impact at t has no answer.
std::string what_pushes(const OneSided& sides, std::size_t i, double t, const System& system, bool movable);

}  // namespace unfurl
