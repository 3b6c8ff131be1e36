// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/live_session.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/panel/document/scene_entries.hpp"
#include "render/image/png.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_trade_points = 200;

template <class Job>
JobState state_of(const Job& job) {
  return {job.busy(), job.progress(), job.doing()};
}

}  // namespace

LiveSession::LiveSession(SceneDocument document, SessionOptions options)
    : options_(std::move(options)),
      state_(std::move(document)),
      export_(options_.wake),
      study_(options_.wake),
      errors_(options_.wake),
      simulator_(options_.wake) {
  describe();
  follow_document();
}

bool LiveSession::take_results() {
  const bool studied = state_.studying.running, exported = state_.exporting.running;
  const auto outcome = simulator_.take();
  if (outcome) take_run(*outcome);
  state_.simulation = state_of(simulator_);
  const std::vector<RunError> errors = errors_.take();
  for (const RunError& error : errors) {
    note_error(state_.trade, error);
    ++state_.trade_news;
  }
  errors_.hold(state_.simulation.running);  // the next run comes first
  if (auto study = study_.take()) state_.studied = std::move(*study);
  state_.studying = state_of(study_);
  if (auto report = export_.take()) state_.message = std::move(*report);
  state_.exporting = state_of(export_);
  return outcome || !errors.empty() || studied != state_.studying.running ||
         exported != state_.exporting.running;
}

void LiveSession::take_run(const SimulationOutcome& outcome) {
  state_.problems = outcome.problems;
  state_.message = outcome.message;
  if (!outcome.run || outcome.run->simulation.trajectory.empty()) return;
  const bool first = !state_.shown;
  state_.shown = outcome.run;
  state_.trade.push_back(trade_point(*state_.shown));
  ++state_.trade_news;
  if (options_.measure_errors)
    errors_.measure(state_.shown);
  else
    note_error(state_.trade, {.run = state_.shown->id, .why = "not asked for"});
  if (state_.trade.size() > most_trade_points) state_.trade.erase(state_.trade.begin());
  if (state_.shown->document == state_.history.now())
    state_.picture = state_.shown->scene.render;
  else
    update_picture();
  const Trajectory& trajectory = state_.shown->simulation.trajectory;
  if (first) state_.playback.t = options_.at;
  state_.playback.t = std::clamp(state_.playback.t, trajectory.start_time(), trajectory.end_time());
}

// How things look needs no simulation.
void LiveSession::update_picture() {
  try {
    state_.picture = read_document(state_.history.now()).render;
    state_.problems.clear();
  } catch (const SceneError& error) {
    state_.problems = error.problems();
  }
}

// What the widgets are of.
void LiveSession::describe() {
  state_.base = base_scene(state_.history.now());
  state_.described = state_.selected;
  state_.sections = param_sections(state_.base, state_.selected);
}

bool LiveSession::act() {
  const auto intents = std::exchange(state_.intents, {});
  for (const Intent& intent : intents) try {
      intent(*this);
    } catch (const SceneError& error) {
      state_.message = error.problems().front().message;
    } catch (const std::exception& error) {
      state_.message = error.what();
    }
  return !intents.empty();
}

// A change of the scene asks for its simulation.
bool LiveSession::follow_document() {
  const SceneDocument& now = state_.history.now();
  const bool other = state_.described != state_.selected;
  if (submitted_ && *submitted_ == now && !other) return false;
  if (other || !submitted_ || *submitted_->text != *now.text || submitted_->overrides != now.overrides ||
      submitted_->added != now.added) {
    try {
      describe();
    } catch (const SceneError& error) {
      if (!submitted_) throw;
      state_.problems = error.problems();
      state_.described = state_.selected;
    }
  }
  if (submitted_ && *submitted_ == now) return true;
  const bool same_run = submitted_ && simulated_part(*submitted_) == simulated_part(now);
  submitted_ = now;
  if (same_run) {
    update_picture();
  } else {
    errors_.hold(true);
    simulator_.submit(now);
    state_.simulation = state_of(simulator_);
  }
  return true;
}

void LiveSession::start_study() {
  if (!study_.busy()) study_.submit({state_.study, simulated_part(state_.history.now())});
}

void LiveSession::start_export(const std::string& verb) {
  export_.submit({own_program(), export_words(state_.history.now(), verb, state_.export_output)});
  state_.message = "exporting to " + state_.export_output + " \u2026";
}

void LiveSession::save(const std::string& path) {
  bool anew = false;
  state_.history.saved(save_document(state_.history.now(), path, anew));
  state_.message = "saved " + path + (anew ? " (written anew)" : "");
  state_.export_path = path;
}

void LiveSession::add_entry(const std::string& table, std::string_view kind) {
  const SceneDocument& now = state_.history.now();
  state_.history.replace(with_entry(now, new_entry(now, table, kind, state_.selected)));
}

void LiveSession::open(const SceneDocument& document) {
  state_.history.replace(document);
  state_.orbit.reset();
}

void LiveSession::screenshot() {
  if (!options_.picture) return;
  std::string name = "unfurl.png";
  for (int i = 1; std::filesystem::exists(name); ++i) name = "unfurl_" + std::to_string(i) + ".png";
  write_png(name, options_.picture());
  state_.message = "screenshot: " + name;
}

}  // namespace unfurl
