// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/initial_state.hpp"
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
  // The sample, kept where there is room: of large structures a few.
  const Sample& keep(Key key, Sample sample);
  // What is asked of a piece: diagnose_energies(), or diagnose_states() without or with reactions.
  enum class Of { energies, motion, reactions };
  const Diagnostics& of(const Simulation& piece, Of what);
  // project(), of one model after another.
  void move_onto_constraints(const Model& model, State& state);

  // What is known of the motion around a state of a run.
  std::map<std::pair<const Simulation*, std::size_t>, std::shared_ptr<const void>> around;
  // Steps of a run into which all are to look.
  std::map<const Simulation*, std::optional<std::vector<std::size_t>>> long_steps;

 private:
  std::map<Key, Sample> kept_;
  std::set<const Simulation*> pieces_;  // of those
  std::map<std::pair<const Simulation*, Of>, Diagnostics> found_;
  std::size_t numbers_ = 0;     // in them
  std::optional<Sample> last_;  // for which there is no room
  Diagnostics last_found_;
  const Model* projected_ = nullptr;
  std::optional<Projector> projector_;  // of that
};

// Of the RememberedExtremes of this thread; null: there is none.
MotionSamples* remembered_samples();
void move_onto_constraints(const Model& model, State& state);
// Whether a column is a function of the state alone, which samples then tell.
bool of_the_state(const Series& column);
// The run at a quarter, the middle and three quarters of the step from state k on: remembered, or `made`.
const Simulation& inside_step(const Simulation& run, std::size_t k,
                              std::optional<MotionSamples::Sample>& made);
// MotionSamples::of() of those, or `made` where there are none.
const Diagnostics& judged_piece(const Simulation& piece, MotionSamples::Of what, Diagnostics& made);
// Which of these tells a column.
MotionSamples::Of table_of(const Series& column);

}  // namespace unfurl
