// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/run_ahead.hpp"

#include <cstring>
#include <thread>
#include <utility>

#include "app/output/interrupt.hpp"

namespace unfurl {

namespace {

constexpr std::size_t unsettled = 8;  // states at the end, of which events take some back

int helpers(int threads) {
  return threads == 1 || std::thread::hardware_concurrency() == 1 ? 0 : 1;
}

std::shared_ptr<const Model> kept_elsewhere(const Model& model) {
  return std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model);
}

template <class Numbers>
bool same_bits(const Numbers& a, const Numbers& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0);
}

bool same_state(const State& a, const State& b) {
  return std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && same_bits(a.z, b.z) && same_bits(a.w, b.w) &&
         same_bits(a.lambda, b.lambda) && same_bits(a.tension, b.tension) &&
         same_bits(a.tension_error, b.tension_error) && same_bits(a.angles, b.angles) &&
         same_bits(a.stage_tension, b.stage_tension);
}

// The states of a piece stand at these of the run.
bool holds(const Trajectory& run, std::size_t first, const Trajectory& piece) {
  if (run.size() < first + piece.size()) return false;
  for (std::size_t k = 0; k < piece.size(); ++k)
    if (&run.model(first + k) != &piece.model(k) || !same_state(run.state(first + k), piece.state(k)) ||
        run.report(first + k).singular_event != piece.report(k).singular_event)
      return false;
  return true;
}

}  // namespace

RunAhead::RunAhead(int threads) : on_(helpers(threads) > 0), queue_(helpers(threads)) {}

void RunAhead::look(const Simulation& run, std::size_t states) {
  const Trajectory& so_far = run.trajectory;
  if (!on_ || so_far.size() < next_ + states + unsettled || queue_.any_waiting()) return;
  const bool start = next_ == 0;
  if (start)
    seen_.emplace(Simulation{.trajectory = Trajectory(kept_elsewhere(so_far.model()), so_far.options()),
                             .options = run.options});
  const std::size_t end = next_ + (so_far.size() - unsettled - next_) / states * states;
  Piece& piece = pieces_.emplace_back(Piece{so_far.part(next_, end, {})});
  next_ = end;
  queue_.add([this, &piece, start] { examine(piece, start); });
}

void RunAhead::examine(Piece& piece, bool start) {
  if (interrupted_for(0.5)) return;
  const Trajectory& run = piece.run;
  if (start) mobility_ = analyse_mobility(run.model().system, run.node_positions(0));
  find_forces(run);
  if (flow()) diagnosis_->judge();
  rows_.add(run);
  piece.done = true;
}

void RunAhead::find_forces(const Trajectory& piece) {
  Trajectory& seen = seen_->trajectory;
  if (!flow_) {
    solver_.emplace(seen);
    flow_.emplace(seen, true);
    diagnosis_.emplace(*seen_, KnownAhead{&forces_, &flow_->so_far()});
  }
  for (std::size_t k = 0; k < piece.size(); ++k) {
    if (&piece.model(k) != &seen.last_model()) seen.change_model(kept_elsewhere(piece.model(k)));
    seen.append(piece.state(k), piece.report(k));
  }
  for (std::size_t i = forces_.size(); i < seen.size() && !interrupted_for(0.5); ++i) {
    if (i > 0) flow_->step_to(i, &*solver_);
    forces_.push_back(solver_->at(i));
  }
}

void RunAhead::stop() {
  if (!std::exchange(on_, false)) return;
  queue_.finish();
  drop();
}

void RunAhead::drop() {
  diagnosis_.reset();
  flow_.reset();
  solver_.reset();
  seen_.reset();
  pieces_.clear();
  forces_.clear();
  rows_ = {};
  mobility_.reset();
}

void RunAhead::take(const Trajectory& run) {
  queue_.finish();
  std::size_t states = 0;
  for (const Piece& piece : pieces_) {
    if (!piece.done || !holds(run, states, piece.run)) return drop();
    states += piece.run.size();
  }
  if (pieces_.empty()) return;
  pieces_.push_back({run.part(states, run.size(), {})});
  find_forces(pieces_.back().run);
}

PendingFile& RunAhead::trajectory_csv(const std::filesystem::path& directory, const Trajectory& run) {
  if (!trajectory_csv_ || written_ != run.size()) {
    rows_.cut(run.size());
    trajectory_csv_.emplace(directory / "trajectory.csv");
    write_trajectory_csv(*trajectory_csv_, run, rows_);
    written_ = run.size();
  }
  return *trajectory_csv_;
}

}  // namespace unfurl
