// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/actions.hpp"

#include <algorithm>
#include <utility>

namespace unfurl {

namespace {

const Trajectory* trajectory_of(const PanelState& state) {
  return state.shown ? &state.shown->simulation.trajectory : nullptr;
}

void play(PanelState& state) {
  if (const auto* run = trajectory_of(state))
    state.playback = toggled(state.playback, run->start_time(), run->end_time());
}

// To the next time of a state that was solved for, or the last one; of an event there are two at its time.
void step(PanelState& state, int way) {
  const auto* run = trajectory_of(state);
  if (!run) return;
  state.playback.playing = false;
  const double now = state.playback.t;
  std::size_t i = way > 0 ? run->size() - 1 : 0;
  for (std::size_t k = 0; k < run->size(); ++k) {
    if (way < 0 && run->time(k) < now) i = k;
    if (way > 0 && run->time(k) > now) i = std::min(i, k);
  }
  state.playback.t = run->time(i);
}

void leap(PanelState& state, int way) {
  const auto* run = trajectory_of(state);
  if (!run) return;
  state.playback.playing = false;
  const double start = run->start_time(), end = run->end_time();
  state.playback.t = std::clamp(state.playback.t + way * 0.05 * (end - start), start, end);
}

void go(PanelState& state, bool to_end) {
  const auto* run = trajectory_of(state);
  if (!run) return;
  state.playback.playing = false;
  state.playback.t = to_end ? run->end_time() : run->start_time();
}

void reset_edits(LiveSession& session) {
  EditHistory& history = session.state().history;
  history.replace(without_edits(history.now()));
}

void escape(LiveSession& session) {
  PanelState& state = session.state();
  if (close_box(state)) return;
  if (state.pose)
    session.let_go();
  else if (state.simulation.running)
    session.stop_simulation();
  else if (state.selected.kind != Selection::Kind::none)
    state.selected = {};
  else
    state.tool = Tool::read;
}

void save_scene(LiveSession& session) {
  session.save_or_ask();
}

void open_palette(LiveSession& session) {
  PanelState& state = session.state();
  state.palette_open = true;
  state.palette_query.clear();
  state.palette_row = 0;
}

void pin(PanelState& state) {
  state.pinned = state.pinned ? nullptr : state.shown;
}

// An action that changes the state alone.
template <auto change>
void on(LiveSession& session) {
  change(session.state());
}

// One that turns something on and off.
template <bool PanelState::*flag>
void toggle(LiveSession& session) {
  session.state().*flag = !(session.state().*flag);
}

}  // namespace

std::span<const Action> actions() {
  using S = PanelState;
  static constexpr Action rows[] = {
      {Key::space, false, false, "Space", "play or pause", on<play>},
      {Key::left, false, false, "\u2190", "one step back", on<[](S& s) { step(s, -1); }>},
      {Key::right, false, false, "\u2192", "one step forward", on<[](S& s) { step(s, 1); }>},
      {Key::left, false, true, "Shift \u2190", "a twentieth back", on<[](S& s) { leap(s, -1); }>},
      {Key::right, false, true, "Shift \u2192", "a twentieth forward", on<[](S& s) { leap(s, 1); }>},
      {Key::home, false, false, "Home", "to the start", on<[](S& s) { go(s, false); }>},
      {Key::end, false, false, "End", "to the end", on<[](S& s) { go(s, true); }>},
      {Key::f, false, false, "F", "frame: see the whole motion", on<[](S& s) { s.orbit.reset(); }>},
      {Key::v, false, false, "V", "use this view for the film", [](LiveSession& s) { s.use_view(true); }},
      {Key::k, false, false, "K", "camera key here, at the present time",
       [](LiveSession& s) { s.use_view(false); }},
      {Key::g, false, false, "G", "pull nodes by hand, or no longer",
       [](LiveSession& s) { s.take_tool(Tool::pull); }},
      {Key::b, false, false, "B", "build: nodes and rods, or no longer",
       [](LiveSession& s) { s.take_tool(Tool::build); }},
      {Key::w, false, false, "W", "wiggle: the next free motion of this pose",
       [](LiveSession& s) { s.wiggle(); }},
      {Key::del, false, false, "Del", "take the selected node or rod away",
       [](LiveSession& s) { s.remove_selected(); }},
      {Key::o, true, false, "Ctrl O", "open a file, a new scene", toggle<&S::files_open>},
      {Key::s, true, false, "Ctrl S", "save the scene", &save_scene},
      {Key::e, false, false, "E", "export", toggle<&S::export_open>},
      {Key::s, false, false, "S", "screenshot, a PNG in the current directory",
       [](LiveSession& s) { s.screenshot(); }},
      {Key::r, false, false, "R", "reset every change of the scene", reset_edits},
      {Key::z, true, false, "Ctrl Z", "undo", on<[](S& s) { s.history.undo(); }>},
      {Key::y, true, false, "Ctrl Y", "redo", on<[](S& s) { s.history.redo(); }>},
      {Key::z, true, true, "Ctrl Shift Z", "redo once more", on<[](S& s) { s.history.redo(); }>},
      {Key::p, false, false, "P", "pin this run as A to compare with, or no longer", on<pin>},
      {Key::p, true, false, "Ctrl P", "find an action or a parameter", open_palette},
      {Key::l, false, false, "L", "the film's title and time",
       on<[](S& s) { s.view.labels = !s.view.labels; }>},
      {Key::t, false, false, "T", "light or dark", toggle<&S::dark>},
      {Key::one, false, false, "1", "hide or show the left pane", toggle<&S::left_open>},
      {Key::two, false, false, "2", "hide or show the right pane", toggle<&S::right_open>},
      {Key::three, false, false, "3", "on the right: figures or studies", toggle<&S::studies_open>},
      {Key::none, false, false, "", "guided tour", on<[](S& s) { s.tour = 1; }>},
      {Key::f1, false, false, "F1, ?", "list of keys", toggle<&S::help_open>},
      {Key::escape, false, false, "Esc", "close what is open, stop a simulation, select nothing", escape},
      {Key::q, true, false, "Ctrl Q", "quit", [](LiveSession& s) { s.ask_to_close(); }},
  };
  return rows;
}

bool close_box(PanelState& state) {
  if (!state.question.text.empty()) return state.question = {}, true;
  if (state.tour > 0) return state.tour = 0, true;
  for (bool PanelState::*box :
       {&PanelState::palette_open, &PanelState::files_open, &PanelState::export_open, &PanelState::help_open})
    if (std::exchange(state.*box, false)) return true;
  return false;
}

void press(LiveSession& session, const InputEvent& event) {
  if (event.alt) return;
  for (const Action& row : actions())
    if (row.key != Key::none && row.key == event.key && row.control == event.control &&
        row.shift == event.shift)
      return row.act(session);
}

}  // namespace unfurl
