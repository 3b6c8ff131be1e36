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

// A run begins with these states.
bool begins_with(const Trajectory& run, const Trajectory& states) {
  if (run.size() < states.size()) return false;
  for (std::size_t k = 0; k < states.size(); ++k)
    if (&run.model(k) != &states.model(k) || !same_state(run.state(k), states.state(k)) ||
        run.report(k).singular_event != states.report(k).singular_event)
      return false;
  return true;
}

}  // namespace

RunAhead::RunAhead(int threads) : on_(helpers(threads) > 0), queue_(helpers(threads)) {}

void RunAhead::look(const Simulation& run, std::size_t states) {
  const Trajectory& so_far = run.trajectory;
  if (!on_ || so_far.size() < next_ + states + unsettled || queue_.any_waiting()) return;
  if (next_ == 0)
    seen_.emplace(Simulation{.trajectory = so_far.part(0, 0, so_far.options()), .options = run.options});
  const std::size_t end = next_ + (so_far.size() - unsettled - next_) / states * states;
  queue_.add([this, piece = std::make_shared<Trajectory>(so_far.part(next_, end, {}))] { examine(*piece); });
  next_ = end;
}

void RunAhead::examine(Trajectory& piece) {
  if (interrupted_for(0.5)) return;
  if (!mobility_) mobility_ = analyse_mobility(piece.model().system, piece.node_positions(0));
  rows_.add(piece);
  find_forces(std::move(piece));
  if (flow()) diagnosis_->judge([this] { return ended_ || interrupted_for(0.5); });
}

void RunAhead::find_forces(Trajectory&& piece) {
  Trajectory& seen = seen_->trajectory;
  if (!flow_) {
    solver_.emplace(seen);
    flow_.emplace(seen, true);
    diagnosis_.emplace(*seen_, KnownAhead{&forces_, &flow_->so_far()});
  }
  seen.append(std::move(piece));
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
  forces_.clear();
  rows_ = {};
  mobility_.reset();
}

void RunAhead::take(const Trajectory& run) {
  ended_ = true;
  queue_.finish();
  if (next_ == 0) return;
  if (rows_.states() != next_ || !begins_with(run, seen_->trajectory)) return drop();
  find_forces(run.part(next_, run.size(), {}));
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
