// SPDX-License-Identifier: BSD-3-Clause
// What a second core does for a run.
#pragma once

#include <atomic>
#include <optional>

#include "core/diagnostics/diagnosis_ahead.hpp"
#include "core/diagnostics/energy_flow.hpp"
#include "core/diagnostics/state_forces.hpp"
#include "core/export/csv.hpp"
#include "core/simulate/parts.hpp"
#include "core/system/mobility.hpp"
#include "render/image/task_queue.hpp"

namespace unfurl {

// While a run is solved, its first states are looked at already: forces, energy that flows in and out, their
// diagnosis, rows of trajectory.csv, mobility at the start. It is used where the run's states are still the
// same to the bit when it has ended. On one core, or with one thread, nothing is done ahead, and what is
// given to beside() is done at once.
class RunAhead {
 public:
  explicit RunAhead(int threads);  // at most; 0: as many as the machine has

  // For Parts::look; `states`: how many are looked at together, or more where the other core is behind: the
  // run does not wait for it.
  void look(const Simulation& run, std::size_t states);
  void stop();  // the run is handed over in parts: nothing of it is of use

  // Behind the run's last step: the rest of its forces is found, and all of what was found is dropped where
  // the run took back a state that was looked at.
  void take(const Trajectory& run);
  // DIR/trajectory.csv of these states, which has no name yet; not written again while they are as many.
  PendingFile& trajectory_csv(const std::filesystem::path& directory, const Trajectory& run);
  const std::vector<SolvedPoint>& forces() const { return forces_; }
  const EnergyFlow* flow() const { return knows_all() ? &flow_->so_far() : nullptr; }  // of a whole run
  DiagnosisAhead* diagnosis() { return knows_all() ? &*diagnosis_ : nullptr; }  // of one that was begun
  const std::optional<Mobility>& mobility() const { return mobility_; }

  TaskQueue& beside() { return queue_; }  // one thread, tasks in their order

 private:
  void examine(Trajectory& piece);       // which is taken over
  void find_forces(Trajectory&& piece);  // and what flows in and out
  bool knows_all() const { return flow_ && forces_.size() == seen_->trajectory.size(); }
  void drop();

  bool on_;
  std::atomic<bool> ended_ = false;  // the run: what is not judged yet diagnose() judges beside the poses
  std::size_t next_ = 0;             // state
  std::optional<Mobility> mobility_;
  std::optional<Simulation> seen_;  // all pieces
  std::optional<StateForces> solver_;
  std::optional<RunEnergyFlow> flow_;
  std::vector<SolvedPoint> forces_;
  std::optional<DiagnosisAhead> diagnosis_;
  RowsAhead rows_;
  std::optional<PendingFile> trajectory_csv_;
  std::size_t written_ = 0;  // states
  TaskQueue queue_;          // last: it ends before what it works on
};

}  // namespace unfurl
