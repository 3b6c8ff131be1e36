// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/shortcuts.hpp"

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

void reset_edits(PanelState& state) {
  state.history.replace(without_edits(state.history.now()));
}

void escape(PanelState& state) {
  if (state.help_open || state.export_open)
    state.help_open = state.export_open = false;
  else if (state.pending)
    state.wants_stop = true;
  else
    state.selected = {};
}

void pin(PanelState& state) {
  state.pinned = state.pinned ? nullptr : state.shown;
}

}  // namespace

std::span<const Shortcut> shortcuts() {
  static constexpr Shortcut rows[] = {
      {Key::space, false, false, "space", "play, pause", play},
      {Key::left, false, false, "\u2190 \u2192", "one step back, forward",
       [](PanelState& s) { step(s, -1); }},
      {Key::right, false, false, "", "", [](PanelState& s) { step(s, 1); }},
      {Key::left, false, true, "Shift \u2190 \u2192", "a twentieth back, forward",
       [](PanelState& s) { leap(s, -1); }},
      {Key::right, false, true, "", "", [](PanelState& s) { leap(s, 1); }},
      {Key::home, false, false, "Home, End", "to the start, the end", [](PanelState& s) { go(s, false); }},
      {Key::end, false, false, "", "", [](PanelState& s) { go(s, true); }},
      {Key::f, false, false, "F", "frame: see the whole motion", [](PanelState& s) { s.orbit.reset(); }},
      {Key::r, false, false, "R", "reset every change of the scene", reset_edits},
      {Key::z, true, false, "Ctrl Z", "undo", [](PanelState& s) { s.history.undo(); }},
      {Key::y, true, false, "Ctrl Y", "redo, also Ctrl Shift Z", [](PanelState& s) { s.history.redo(); }},
      {Key::z, true, true, "", "", [](PanelState& s) { s.history.redo(); }},
      {Key::p, false, false, "P", "pin this run as A to compare with; again: no longer", pin},
      {Key::s, false, false, "S", "screenshot, a PNG in the current directory",
       [](PanelState& s) { s.wants_screenshot = true; }},
      {Key::e, false, false, "E", "export", [](PanelState& s) { s.export_open = !s.export_open; }},
      {Key::l, false, false, "L", "the film's title and time",
       [](PanelState& s) { s.view.labels = !s.view.labels; }},
      {Key::t, false, false, "T", "light or dark", [](PanelState& s) { s.dark = !s.dark; }},
      {Key::one, false, false, "1, 2", "hide or show the left, the right pane",
       [](PanelState& s) { s.left_open = !s.left_open; }},
      {Key::two, false, false, "", "", [](PanelState& s) { s.right_open = !s.right_open; }},
      {Key::three, false, false, "3", "on the right: figures or studies",
       [](PanelState& s) { s.studies_open = !s.studies_open; }},
      {Key::f1, false, false, "F1, ?", "this list", [](PanelState& s) { s.help_open = !s.help_open; }},
      {Key::escape, false, false, "Esc", "close a box, stop a simulation, select nothing", escape},
      {Key::q, true, false, "Ctrl Q", "quit", [](PanelState& s) { s.wants_quit = true; }},
  };
  return rows;
}

void press(PanelState& state, const InputEvent& event) {
  if (event.alt) return;
  for (const Shortcut& row : shortcuts())
    if (row.key == event.key && row.control == event.control && row.shift == event.shift)
      return row.act(state);
}

void map_keys(ImGuiIO& io) {
  constexpr std::pair<ImGuiKey, Key> pairs[] = {{ImGuiKey_Tab, Key::tab},
                                                {ImGuiKey_LeftArrow, Key::left},
                                                {ImGuiKey_RightArrow, Key::right},
                                                {ImGuiKey_UpArrow, Key::up},
                                                {ImGuiKey_DownArrow, Key::down},
                                                {ImGuiKey_PageUp, Key::page_up},
                                                {ImGuiKey_PageDown, Key::page_down},
                                                {ImGuiKey_Home, Key::home},
                                                {ImGuiKey_End, Key::end},
                                                {ImGuiKey_Insert, Key::insert},
                                                {ImGuiKey_Delete, Key::del},
                                                {ImGuiKey_Backspace, Key::backspace},
                                                {ImGuiKey_Space, Key::space},
                                                {ImGuiKey_Enter, Key::enter},
                                                {ImGuiKey_Escape, Key::escape},
                                                {ImGuiKey_A, Key::a},
                                                {ImGuiKey_C, Key::c},
                                                {ImGuiKey_V, Key::v},
                                                {ImGuiKey_X, Key::x},
                                                {ImGuiKey_Y, Key::y},
                                                {ImGuiKey_Z, Key::z}};
  for (const auto& [theirs, ours] : pairs) io.KeyMap[theirs] = static_cast<int>(ours);
}

}  // namespace unfurl
