// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

// States within steps of a run that were looked at, and what was found of them: the extremes of many columns
// are looked for at the same ones.
class MotionSamples {
 public:
  struct Sample {
    Simulation piece;         // these states alone
    std::vector<char> moves;  // 0: that is no motion of the structure
  };
  // The run, the state around which they lie, whether all steps count, times.
  using Key = std::tuple<const Simulation*, std::size_t, bool, std::vector<double>>;

  const Sample* find(const Key& key) const;
  // The sample, kept where there is room: large structures are not.
  const Sample& keep(Key key, Sample sample);
  // diagnose_states(), or diagnose_energies(), of a piece.
  const Diagnostics& of(const Simulation& piece, bool energies);

 private:
  std::map<Key, Sample> kept_;
  std::set<const Simulation*> pieces_;  // of those
  std::map<std::pair<const Simulation*, bool>, Diagnostics> found_;
  std::size_t numbers_ = 0;     // in them
  std::optional<Sample> last_;  // for which there is no room
  Diagnostics last_found_;
};

// Of the RememberedExtremes of this thread; null: there is none.
MotionSamples* remembered_samples();
// MotionSamples::of() of those, or `made` where there are none.
const Diagnostics& judged_piece(const Simulation& piece, bool energies, Diagnostics& made);

}  // namespace unfurl
