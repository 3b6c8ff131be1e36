// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/live_session.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <set>
#include <thread>
#include <utility>

#include "app/panel/document/file_list.hpp"
#include "app/panel/document/scene_entries.hpp"
#include "app/panel/view/film_camera.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/scene_error.hpp"
#include "core/scene/title.hpp"
#include "core/scene/write.hpp"
#include "core/scene/write_back.hpp"
#include "render/image/png.hpp"
#include "render/scene/camera_path.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_trade_points = 200;
constexpr int presses_told = 4;  // a message outlives fewer

template <class Job>
JobState state_of(const Job& job) {
  return {job.busy(), job.progress(), job.doing()};
}

bool holds_files(const std::string& folder) {
  std::error_code unknown;
  return std::filesystem::is_directory(folder, unknown) && !std::filesystem::is_empty(folder, unknown);
}

std::string absolute(const std::string& path) {
  std::error_code unknown;
  const auto whole = std::filesystem::absolute(path, unknown);
  return unknown ? path : whole.lexically_normal().string();
}

std::filesystem::file_time_type written(const std::string& file) {
  std::error_code unknown;
  return std::filesystem::last_write_time(file, unknown);
}

// Why the document would be another scene in another folder than that of `from`: a file that it names is not
// there, or holds something else. Else empty.
std::string other_there(const SceneDocument& document, const SceneDocument& from) {
  if (absolute(document.folder) == absolute(from.folder)) return "";
  std::string here, title;
  try {
    const Scene scene = read_document(from);
    here = scene_text(scene), title = scene.title;
  } catch (const SceneError&) {  // what is wrong here may be wrong there
  }
  try {
    Scene there = read_document(document);
    there.title = title;  // where none is given, the file's name
    if (here.empty() || there.files.empty() || scene_text(there) == here) return "";
    return *there.files.begin() + (there.files.size() > 1 ? ", or another that the scene names," : "") +
           " holds something else there";
  } catch (const SceneError& error) {
    for (const SceneProblem& problem : error.problems())
      if (!here.empty() || problem.message.starts_with("cannot read ")) return problem.message;
  }
  return "";
}

// Of those that have one line of the panel.
std::string in_a_line(const SceneError& error) {
  const std::size_t more = error.problems().size() - 1;
  return problem_text(error.problems().front()) + (more > 0 ? "; and " + std::to_string(more) + " more" : "");
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

// Or, where a session is played again, what had come in this frame: its numbers are made anew, its times are
// those that were measured.
void LiveSession::collect() {
  if (!options_.replayed) {
    arrived_ = {};
    outcome_ = simulator_.take();
    arrived_.run = outcome_.has_value();
    if (outcome_ && outcome_->run) {
      arrived_.run_cpu_s = outcome_->run->simulation.cpu_s;
      arrived_.coarse = outcome_->run->coarse;
    }
    arrived_.errors = errors_.take();
    auto study = study_.take();
    arrived_.study = study.has_value();
    if (study) state_.studied = std::move(*study);
    arrived_.report = export_.take().value_or("");
    arrived_.simulation = state_of(simulator_);
    arrived_.simulation.late = simulator_.late(options_.moment);
    arrived_.studying = state_of(study_);
    arrived_.exporting = state_of(export_);
    arrived_.own_file = own_file_.look(state_.history.now(), last_saved());
    return;
  }
  const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  outcome_.reset();
  while (arrived_.run && !outcome_ && simulator_.busy())
    if (outcome_ = simulator_.take(); !outcome_)
      wait();
    else if (outcome_->run && outcome_->run->coarse && !arrived_.coarse)
      outcome_.reset();  // it was not looked at
  if (outcome_ && outcome_->run) {
    LiveRun run = *outcome_->run;
    run.simulation.cpu_s = arrived_.run_cpu_s;
    outcome_->run = std::make_shared<const LiveRun>(std::move(run));
  }
  std::optional<std::shared_ptr<const StudyOutcome>> study;
  while (arrived_.study && !study && study_.busy())
    if (!(study = study_.take())) wait();
  if (study) state_.studied = std::move(*study);
}

bool LiveSession::take_results() {
  collect();
  const bool other = state_.simulation.late != arrived_.simulation.late ||
                     state_.studying.running != arrived_.studying.running ||
                     state_.exporting.running != arrived_.exporting.running ||
                     state_.own_file != arrived_.own_file;
  if (outcome_) take_run(*outcome_);
  for (const RunError& error : arrived_.errors) {
    note_error(state_.trade, error);
    ++state_.trade_news;
  }
  state_.simulation = arrived_.simulation;
  state_.studying = arrived_.studying;
  state_.exporting = arrived_.exporting;
  if (arrived_.own_file == OwnFile::changed && state_.own_file != OwnFile::changed)
    state_.message =
        absolute(state_.history.now().path) + " was changed by another program since it was opened";
  state_.own_file = arrived_.own_file;
  errors_.hold(state_.simulation.running || outcome_);  // the next run, and showing it, come first
  if (!arrived_.report.empty()) {
    state_.message = arrived_.report;
    state_.exported = exporting_to_;
  }
  return outcome_ || !arrived_.errors.empty() || other;
}

void LiveSession::take_run(const SimulationOutcome& outcome) {
  state_.problems = outcome.problems;
  failure_ = outcome.message;
  // What was said of the same document ("saved ...") stays when its run comes.
  const bool another = !outcome.run || (state_.shown && state_.shown->document != outcome.run->document);
  const bool saved = outcome.run && saved_ && outcome.run->document == *saved_;
  if ((another && !saved) || !outcome.message.empty()) state_.message = outcome.message;
  if (!outcome.run || outcome.run->simulation.trajectory.empty()) return;
  const bool first = !state_.shown;
  let_go();  // of the run before
  state_.shown = outcome.run;
  if (!state_.shown->coarse) judge_run();
  if (state_.shown->document == state_.history.now())
    state_.picture = state_.shown->scene.render;
  else
    update_picture();
  const Trajectory& trajectory = state_.shown->simulation.trajectory;
  if (first) state_.playback.t = options_.at;
  state_.playback.t = std::clamp(state_.playback.t, trajectory.start_time(), trajectory.end_time());
}

// What is still so stays: that the present run failed, that an export goes on.
void LiveSession::note_press() {
  if (std::exchange(told_, state_.message) != state_.message) presses_ = 0;
  const bool lasts = state_.message == failure_ || state_.exporting.running;
  if (lasts || ++presses_ < presses_told) return;
  state_.message.clear();
  told_.clear();
}

void LiveSession::judge_run() {
  state_.trade.push_back(trade_point(*state_.shown));
  ++state_.trade_news;
  if (options_.measure_errors && !options_.replayed)
    errors_.measure(state_.shown);
  else if (!options_.measure_errors)
    note_error(state_.trade, {.run = state_.shown->id, .why = "not asked for"});
  if (state_.trade.size() > most_trade_points) state_.trade.erase(state_.trade.begin());
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

// Since they were read. In a replay they are as they are.
bool LiveSession::named_files_changed() const {
  return !options_.replayed && std::ranges::any_of(named_files_, [](const auto& file) {
    return file.second != written(file.first);
  });
}

bool LiveSession::files_changed() {
  return !options_.replayed &&
         (named_files_changed() || own_file_.look(state_.history.now(), last_saved()) != state_.own_file);
}

// What the widgets are of.
void LiveSession::describe() {
  for (auto& [file, when] : named_files_) when = written(file);  // looked at before they are read
  state_.base = base_scene(state_.history.now());
  state_.described = state_.selected;
  state_.sections = param_sections(state_.base, state_.selected);
  const Scene& base = state_.base;
  if (!submitted_ || *submitted_->text != *state_.history.now().text)
    for (const ParamSection& section : state_.sections)  // two screens full of springs help nobody
      for (const ParamEntry& entry : section.entries)
        if (section.entries.size() > 3) state_.folded.insert(entry.key);
  state_.title_row = {"title", "title", text_param("title", "", "of pictures and figures"),
                      base.title_pattern.empty() ? title_that_says(base.title) : base.title_pattern};
}

// The CSV files of the scene as edited; an edit may name another.
void LiveSession::watch_files() {
  std::set<std::string> files = state_.base.files;
  const auto names_file = [](const auto& edit) {
    return edit.first.ends_with("table") || edit.first.ends_with("_file");
  };
  const SceneDocument& now = state_.history.now();
  if (std::ranges::any_of(now.edits, names_file)) try {
      files = read_document(now).files;
    } catch (const SceneError&) {  // told by its run
    }
  std::erase_if(named_files_, [&](const auto& file) { return !files.contains(file.first); });
  for (const std::string& file : files) named_files_.try_emplace(file, written(file));
}

bool LiveSession::act() {
  const auto intents = std::exchange(state_.intents, {});
  for (const Intent& intent : intents) try {
      intent(*this);
    } catch (const SceneError& error) {
      state_.message = in_a_line(error);
    } catch (const std::exception& error) {
      state_.message = error.what();
    }
  return !intents.empty();
}

// A change of the scene asks for its simulation.
bool LiveSession::follow_document() {
  const SceneDocument& now = state_.history.now();
  const bool other = state_.described != state_.selected, reread = submitted_ && named_files_changed();
  if (submitted_ && *submitted_ == now && !other && !reread) return false;
  if (reread) state_.message = "files that the scene names were changed: read again";
  if (other || reread || !submitted_ || *submitted_->text != *now.text || submitted_->folder != now.folder ||
      submitted_->overrides != now.overrides || submitted_->added != now.added) {
    try {
      describe();
    } catch (const SceneError& error) {
      if (!submitted_) throw;
      state_.problems = error.problems();
      state_.described = state_.selected;
    }
  }
  watch_files();
  if (submitted_ && *submitted_ == now && !reread) return true;
  const bool same_run = submitted_ && !reread && simulated_part(*submitted_) == simulated_part(now);
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

void LiveSession::start_export(FilesThere there, bool as_shown) {
  const std::string output = state_.export_output = at_home(state_.export_output);
  const SceneDocument& now = state_.history.now();
  const ExportKind& kind = export_kinds()[state_.export_kind];
  const auto again = [as_shown](FilesThere files) -> Intent {
    return [files, as_shown](LiveSession& s) { s.start_export(files, as_shown); };
  };
  if (!as_shown && own_file_now() == OwnFile::changed) {
    state_.question = {absolute(now.path) + " was changed by another program since it was opened.",
                       {{"Export what is shown", [there](LiveSession& s) { s.start_export(there, true); }},
                        {"Open it again", [path = now.path](LiveSession& s) { s.open_file(path); }},
                        {"Cancel", {}}}};
    return;
  }
  if (there == FilesThere::asked && holds_files(output)) {
    const std::string begun = export_goes_on_with(now, kind, output);
    const bool loses = export_loses_run(kind, output);
    state_.question = {absolute(output) + (begun.empty() ? " holds files. Replace those of the same names?"
                                                         : " holds " + begun + " of this very scene."),
                       {}};
    auto& [text, answers] = state_.question;
    if (begun.empty() && loses) text += " The unfinished run there would be lost.";
    if (!begun.empty()) answers.emplace_back("Go on", again(FilesThere::go_on));
    if (begun.empty() || loses)  // frames of the same film stay in any case
      answers.emplace_back(begun.empty() ? "Replace" : "Begin anew", again(FilesThere::replaced));
    answers.emplace_back("Cancel", Intent());
    return;
  }
  exporting_to_ = absolute(output);
  state_.message = "exporting to " + exporting_to_ + " \u2026";
  if (options_.replayed) return;
  export_.submit({own_program(), export_words(now, kind, output, there == FilesThere::replaced)});
}

void LiveSession::open_folder() {
  if (options_.replayed) return;
  const std::string folder = state_.exported.empty() ? absolute(".") : state_.exported;
  const int error = folder_.start({"xdg-open", folder}, {});
  state_.message = error == 0 ? "opened " + folder : "there is no xdg-open; the folder is " + folder;
}

// Read anew: it is about to be replaced or run. In a replay, which writes nothing, as it was recorded.
OwnFile LiveSession::own_file_now() const {
  return options_.replayed ? state_.own_file : own_file(state_.history.now(), last_saved());
}

void LiveSession::save(const std::string& typed) {
  std::string path = at_home(typed);
  std::error_code unknown;
  if (std::filesystem::equivalent(path, state_.history.now().path, unknown)) path = state_.history.now().path;
  const bool own = path == state_.history.now().path;
  if (own ? own_file_now() != OwnFile::changed : !std::filesystem::exists(path, unknown))
    return save_now(path);
  const char* why =
      own ? " was changed by another program since it was opened. Replace it?" : " exists. Replace it?";
  state_.question = {absolute(path) + why,
                     {{"Replace", [path](LiveSession& s) { s.save_now(path); }}, {"Cancel", {}}}};
}

void LiveSession::save_now(const std::string& path, bool losing) {
  WrittenBack written;
  const SceneDocument saved = saved_document(state_.history.now(), path, written);
  if (const std::string why = other_there(saved, state_.history.now()); !why.empty()) {
    state_.message = "not saved: " + why + "; the scene names that file: copy it there first";
    return;
  }
  const std::string without = written.lost.empty() ? "" : "without its " + written.lost;
  if (!losing && !without.empty() && path == state_.history.now().path) {
    state_.question = {
        (written.anew ? "" : "A list of ") + absolute(path) + " would be written anew, " + without + ".",
        {{"Save anew", [path](LiveSession& s) { s.save_now(path, true); }},
         {"Save as\u2026", [](LiveSession& s) { s.save_as(); }},
         {"Cancel", {}}}};
    return;
  }
  if (!options_.replayed) write_file_atomically(behind_links(path), *saved.text);
  state_.history.saved(saved);
  saved_ = saved;
  const bool kept = !written.anew && without.empty();
  // What matters comes first: a narrow window has room for that.
  state_.message = kept ? "saved " + absolute(path) + ", comments kept"
                        : std::string(written.anew ? "" : "a list ") + "written anew" +
                              (without.empty() ? "" : ", ") + without + ": " + absolute(path);
  state_.export_path = path;
  remember(path);
}

void LiveSession::save_or_ask() {
  const std::string& path = state_.history.now().path;
  if (!path.empty() && !of_library(path)) return save(path);
  save_as();
}

void LiveSession::save_as() {
  state_.export_open = true;
  state_.message = "a name for the scene's own file, then Save as";
}

void LiveSession::add_entry(const ElementOffer& offer) {
  const SceneDocument& now = state_.history.now();
  state_.history.replace(
      with_entry(now, new_entry(now, offer.table, offer.kind, state_.selected, offer.extra)));
  state_.message = offer.name + ": " + offer.sentence;
}

void LiveSession::open(const SceneDocument& document) {
  read_document(document);  // what is wrong with it is said, and the scene that is open stays
  state_.history.open(document);
  state_.selected = state_.hovered = {};
  const StudyRequest::Kind kind = state_.study.kind;
  state_.study = {};  // of another scene
  state_.study.kind = kind;
  state_.orbit.reset();
  state_.export_path.clear();
  state_.files_open = false;
  state_.message = document.path.empty() ? "a new scene" : "opened " + document.path;
}

void LiveSession::open_file(const std::string& path) {
  open(open_document(at_home(path), {}));
  remember(state_.history.now().path);
}

void LiveSession::remember(const std::string& path) {
  constexpr std::size_t most = 12;
  const std::string whole = absolute(path);
  if (path.empty() || of_library(path)) return;
  std::erase(state_.recent, whole);
  state_.recent.insert(state_.recent.begin(), whole);
  if (state_.recent.size() > most) state_.recent.resize(most);
}

void LiveSession::use_view(bool only) {
  if (!state_.shown) return;
  if (only && !state_.orbit && !moves_camera(state_.picture)) {
    state_.message = "the film has this view already: turn it first";
    return;
  }
  const OrbitCamera view = state_.orbit ? *state_.orbit : film_view(state_);
  state_.history.replace(with_camera(state_, view, only));
  state_.orbit.reset();
  state_.message = only ? "this is the film's view" : "a camera key at the present time";
}

// Undone behind a save, what is shown is in no file either.
bool LiveSession::has_unsaved() const {
  const SceneDocument& now = state_.history.now();
  return is_edited(now) || (saved_ && saved_->path == now.path && *saved_->text != *now.text);
}

void LiveSession::ask_to_close() {
  if (state_.exporting.running) {
    state_.question = {"The export to " + exporting_to_ + " is not done yet; closing the window stops it.",
                       {{"Stop it", [](LiveSession& s) { s.close_or_ask(); }}, {"Cancel", {}}}};
    return;
  }
  close_or_ask();
}

void LiveSession::ask_for_left() {
  const int back = state_.history.steps_to_left();
  state_.closed = back == 0;
  if (state_.closed) return;
  const auto go_back = [back](LiveSession& s) {
    for (int i = 0; i < back; ++i) s.state().history.undo();
  };
  state_.question = {"A scene that was open before has changes that are in no file.",
                     {{"Back to it", go_back},
                      {"Discard", [](LiveSession& s) { s.state().closed = true; }},
                      {"Cancel", {}}}};
}

void LiveSession::close_or_ask() {
  if (!has_unsaved()) return ask_for_left();
  const std::string name = std::filesystem::path(state_.history.now().name).filename().string();
  const auto save = [](LiveSession& s) {
    s.save_or_ask();
    if (!s.has_unsaved()) s.ask_for_left();
  };
  state_.question = {name + " has changes that are in no file.",
                     {{"Save", save}, {"Discard", [](LiveSession& s) { s.ask_for_left(); }}, {"Cancel", {}}}};
}

void LiveSession::screenshot() {
  if (!options_.picture) return;
  std::string name = "unfurl.png";
  for (int i = 1; std::filesystem::exists(name); ++i) name = "unfurl_" + std::to_string(i) + ".png";
  if (!options_.replayed) write_png(name, options_.picture());
  state_.message = "screenshot: " + name;
}

}  // namespace unfurl
