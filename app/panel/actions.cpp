// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/actions.hpp"

#include <algorithm>

namespace unfurl {

namespace {

const Trajectory* trajectory_of(const PanelState& state) {
  return state.shown ? &state.shown->simulation.trajectory : nullptr;
}

void play(PanelState& state) {
  if (const auto* run = trajectory_of(state))
    state.playback = toggled(state.playback, run->start_time(), run->end_time());
}

// To a neighbour among the states that were solved for.
void step(PanelState& state, int way) {
  const auto* run = trajectory_of(state);
  if (!run) return;
  state.playback.playing = false;
  std::size_t i = 0;
  while (i + 1 < run->size() && run->time(i + 1) <= state.playback.t + 1e-12) ++i;
  const bool between = state.playback.t > run->time(i) + 1e-12;
  if (way > 0 && i + 1 < run->size()) ++i;
  if (way < 0 && !between && i > 0) --i;
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
  if (state.help_open || state.export_open)
    state.help_open = state.export_open = false;
  else if (state.simulation.running)
    session.stop_simulation();
  else
    state.selected = {};
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
      {Key::space, false, false, "space", "play, pause", on<play>},
      {Key::left, false, false, "\u2190 \u2192", "one step back, forward", on<[](S& s) { step(s, -1); }>},
      {Key::right, false, false, "", "", on<[](S& s) { step(s, 1); }>},
      {Key::left, false, true, "Shift \u2190 \u2192", "a twentieth back, forward",
       on<[](S& s) { leap(s, -1); }>},
      {Key::right, false, true, "", "", on<[](S& s) { leap(s, 1); }>},
      {Key::home, false, false, "Home, End", "to the start, the end", on<[](S& s) { go(s, false); }>},
      {Key::end, false, false, "", "", on<[](S& s) { go(s, true); }>},
      {Key::f, false, false, "F", "frame: see the whole motion", on<[](S& s) { s.orbit.reset(); }>},
      {Key::r, false, false, "R", "reset every change of the scene", reset_edits},
      {Key::z, true, false, "Ctrl Z", "undo", on<[](S& s) { s.history.undo(); }>},
      {Key::y, true, false, "Ctrl Y", "redo, also Ctrl Shift Z", on<[](S& s) { s.history.redo(); }>},
      {Key::z, true, true, "", "", on<[](S& s) { s.history.redo(); }>},
      {Key::p, false, false, "P", "pin this run as A to compare with; again: no longer", on<pin>},
      {Key::s, false, false, "S", "screenshot, a PNG in the current directory",
       [](LiveSession& s) { s.screenshot(); }},
      {Key::e, false, false, "E", "export", toggle<&S::export_open>},
      {Key::l, false, false, "L", "the film's title and time",
       on<[](S& s) { s.view.labels = !s.view.labels; }>},
      {Key::t, false, false, "T", "light or dark", toggle<&S::dark>},
      {Key::one, false, false, "1, 2", "hide or show the left, the right pane", toggle<&S::left_open>},
      {Key::two, false, false, "", "", toggle<&S::right_open>},
      {Key::three, false, false, "3", "on the right: figures or studies", toggle<&S::studies_open>},
      {Key::f1, false, false, "F1, ?", "this list", toggle<&S::help_open>},
      {Key::escape, false, false, "Esc", "close a box, stop a simulation, select nothing", escape},
      {Key::q, true, false, "Ctrl Q", "quit", on<[](S& s) { s.closed = true; }>},
  };
  return rows;
}

void press(LiveSession& session, const InputEvent& event) {
  if (event.alt) return;
  for (const Action& row : actions())
    if (row.key == event.key && row.control == event.control && row.shift == event.shift)
      return row.act(session);
}

}  // namespace unfurl
