// SPDX-License-Identifier: BSD-3-Clause
// Long runs in parts, and what the rest of a run depends on, as bytes.
#include <algorithm>
#include <utility>

#include "core/simulate/parts.hpp"
#include "core/simulate/stepper_loop.hpp"

namespace unfurl {

namespace {

// Of a part that is over with the last state so far: the first of the states that go on being known, and how
// many belong to the part and to what was before it.
std::pair<std::size_t, std::size_t> end_of_part(const Trajectory& all, std::size_t around) {
  const std::size_t n = all.size();
  std::size_t from = n - 1;
  while (from > 0 && n - from < 2 * around && &all.model(from - 1) == &all.model(n - 1)) --from;
  return {from, std::max(from + 1, n - std::min(n, around))};
}

}  // namespace

// Where parts_for() would have a long run handed over the method begins anew whether it is or not: who keeps
// all of it goes the same way.
void Stepper::Loop::begin_anew_behind_part() {
  const Parts parts = parts_for(*original_);
  if (run_.trajectory.size() - part_ < parts.states + parts.around) return;
  part_ = end_of_part(run_.trajectory, parts.around).second;
  forget();
}

Stepper::Window Stepper::Loop::take_window(std::size_t around) {
  const Trajectory& all = run_.trajectory;
  const std::size_t n = all.size();
  const auto [from, last] = end_of_part(all, around);
  Trajectory rest(original_, run_.options);
  if (present_ != original_) rest.change_model(present_);
  for (std::size_t i = from; i < n; ++i) rest.append(all.state(i), all.report(i));
  Window window{run_, new_, last};
  run_.trajectory = std::move(rest);
  part_ = new_ = last - from;
  forget();
  return window;
}

void Stepper::Loop::stop_reels() {
  Archive sides;
  sides_.archive(sides);
  locked_sides_ = sides.bytes();
  locked_at_ = now().t;
  base_ = sides_.stop_reels(*base_, locked_at_);
}

// What a stepper that was archived does not know either.
void Stepper::Loop::forget() {
  if (control_) last_step_ = control_->last();
  control_.reset();
  controlled_ = nullptr;
  pushed_.reset();
  model_changed();
}

void Stepper::Loop::archive(Archive& archive) {
  archive_states(archive);
  for (long* x : {&run_.steps, &run_.newton_iterations, &run_.factorisations, &crowd_, &in_step_})
    archive(*x);
  archive(run_.warnings);
  archive_events(archive, run_.events);
  archive(new_);
  part_ = new_;
  archive_models(archive);
  archive(turning_back_);
  archive(turned_);
  for (double* x : {&target_, &part_end_, &last_step_, &swing_, &crowd_time_, &unwatched_until_, &margin_})
    archive(*x);
  for (bool* x : {&deployed_, &ended_, &regular_, &rest_ahead_, &contradictions_}) archive(*x);
  bool in_pose = in_pose_.has_value();
  archive(in_pose);
  if (in_pose && archive.reading()) in_pose_.emplace();
  if (in_pose) archive(*in_pose_);
  if (archive.reading()) model_changed();
}

// The models come from what was latched and locked, and from what is held now.
void Stepper::Loop::archive_models(Archive& archive) {
  bool changed = present_ != original_;
  archive(changed);
  archive(latched_);
  archive(locked_sides_);
  archive(locked_at_);
  archive_held(archive);
  const std::size_t held = held_.by_base;
  if (archive.reading()) held_.by_base = 0, hold_nodes(held_.latched);
  if (archive.reading() && !locked_sides_.empty()) {
    Archive sides(locked_sides_);
    sides_.archive(sides);
    base_ = sides_.stop_reels(*base_, locked_at_);
  }
  if (archive.reading() && latched_) base_ = latched_model(*base_, run_.options.eliminate_linear);
  if (archive.reading()) hold_nodes(held);
  sides_.archive(archive);
  if (!archive.reading() || !changed) return;
  present_ = sides_.any_active() ? sides_.model(*base_) : base_;
  Trajectory known(original_, run_.options);
  known.change_model(present_);
  for (std::size_t i = 0; i < run_.trajectory.size(); ++i)
    known.append(run_.trajectory.state(i), run_.trajectory.report(i));
  run_.trajectory = std::move(known);
}

void Stepper::Loop::archive_states(Archive& archive) {
  std::size_t n = run_.trajectory.size();
  archive(n);
  for (std::size_t i = 0; i < n; ++i) {
    State state;
    StepReport report;
    if (!archive.reading()) state = run_.trajectory.state(i), report = run_.trajectory.report(i);
    archive(state.t);
    for (VectorXd* x :
         {&state.z, &state.w, &state.lambda, &state.tension, &state.tension_error, &state.angles})
      archive(*x);
    archive(state.stage_tension);
    archive(report.status);
    for (int* x : {&report.newton_iterations, &report.factorisations, &report.right_hand_sides}) archive(*x);
    for (double* x : {&report.residual, &report.constraint_norm}) archive(*x);
    archive(report.singular_event);
    archive(report.contradictions);
    if (archive.reading()) run_.trajectory.append(std::move(state), report);
  }
  if (n == 0) throw ArchiveError("holds no state");
}

void archive_events(Archive& archive, std::vector<Event>& events) {
  std::size_t n = events.size();
  archive(n);
  if (archive.reading()) events.clear();
  for (std::size_t i = 0; i < n; ++i) {
    Event event = archive.reading() ? Event{} : events[i];
    for (std::string* x : {&event.name, &event.kind, &event.element}) archive(*x);
    for (double* x : {&event.t, &event.energy_lost, &event.singular_value}) archive(*x);
    if (archive.reading()) events.push_back(std::move(event));
  }
}

}  // namespace unfurl
