// When a step runs into an end stop.
#pragma once

#include <functional>
#include <optional>

#include "core/simulate/stops.hpp"

namespace unfurl {

// The state after a step of any length from the same start; nothing where that step cannot be solved.
using StateAfter = std::function<std::optional<State>(double step)>;

// For stop i over a step of length h that begins at `from` and ends at `to`: how long into the step the gap
// closes [s]; nothing where it stays open. It is found by steps of other lengths, not read off an
// interpolant: the Illinois variant of regula falsi on the gap. A gap that closes and opens again within the
// step is seen where its rate changes sign. A stop that is touched and left for less than a millionth of the
// step counts as touched at once.
std::optional<double> time_to_contact(const Stops& stops, std::size_t i, const System& system,
                                      const State& from, const State& to, double h, const StateAfter& after);

}  // namespace unfurl
