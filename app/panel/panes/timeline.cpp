// SPDX-License-Identifier: BSD-3-Clause
// The bottom: play, pause, step, speed, loop, and the time as a line to drag along, with the run's events.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "app/panel/actions.hpp"
#include "app/panel/panes/panes.hpp"

namespace unfurl {

namespace {

void draw_controls(Ui& ui, PanelState& state, double start, double end) {
  Playback& playback = state.playback;
  if (button(ui, "to start", "|\u25C2", "to the start (Home)")) playback.t = start;
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "play", playback.playing ? "Pause" : "\u25B8 Play", "play or pause (space)"))
    playback = toggled(playback, start, end);
  ImGui::SameLine(0, ui.px(4));
  if (ImGui::GetWindowWidth() > ui.px(900)) {  // else by keys alone
    for (const auto& [key, name, help] : {std::tuple(Key::left, "\u2212", "one step back (\u2190)"),
                                          std::tuple(Key::right, "+", "one step on (\u2192)")}) {
      InputEvent event;
      event.kind = InputEvent::Kind::key;
      event.key = key;
      if (button(ui, std::string("step ") + name, name, help))
        state.intents.emplace_back([event](LiveSession& s) { press(s, event); });
      ImGui::SameLine(0, ui.px(4));
    }
  }
  if (button(ui, "to end", "\u25B8|", "to the end (End)")) playback.t = end;
  ImGui::SameLine(0, ui.px(12));
  ImGui::Checkbox("loop", &playback.loop);
  ui.note("loop");
  ImGui::SameLine(0, ui.px(12));
  ImGui::SetNextItemWidth(ui.px(96));
  const double slowest = end > start ? std::min(0.01, (end - start) / 100) : 0.01,
               fastest = std::max(100.0, (end - start) / 10);
  ImGui::SliderScalar("##speed", ImGuiDataType_Double, &playback.speed, &slowest, &fastest,
                      "speed \u00D7%.3g", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat);
  ui.note("speed");
  tooltip(ui, "seconds of motion per second");
}

struct Bar {
  ImVec2 low, high;
  double start, end;
  float x(double t) const {
    const double share = end > start ? (t - start) / (end - start) : 0;
    return low.x + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (high.x - low.x);
  }
  double t(float at) const {
    const double share = std::clamp((at - low.x) / std::max(1.0f, high.x - low.x), 0.0f, 1.0f);
    return start + share * (end - start);
  }
};

void draw_events(const Ui& ui, const PanelState& state, const Bar& bar) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  float free_from = bar.low.x - 1;  // where no label stands yet
  for (const Event& event : state.shown->simulation.events) {
    const float x = bar.x(event.t), y = bar.low.y;
    list.AddTriangleFilled({x - ui.px(5), y - ui.px(2)}, {x + ui.px(5), y - ui.px(2)}, {x, y + ui.px(6)},
                           ui.color(ui.theme.warning));
    char text[96];
    std::snprintf(text, sizeof text, "%s %.5g s", event.name.c_str(), event.t);
    const float wide = ui.small->CalcTextSizeA(ui.small->FontSize, FLT_MAX, 0, text).x;
    const float left = std::clamp(x - wide / 2, bar.low.x, std::max(bar.low.x, bar.high.x - wide));
    if (left > free_from) {
      list.AddText(ui.small, ui.small->FontSize, {left, y - ui.px(5) - ui.small->FontSize},
                   ui.color(ui.theme.warning), text);
      free_from = left + wide + ui.px(6);
    }
    if (std::hypot(mouse.x - x, mouse.y - y) < ui.px(9)) ImGui::SetTooltip("%s", text);
  }
}

void draw_bar(Ui& ui, PanelState& state, double start, double end) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(ui.px(40), ImGui::GetContentRegionAvail().x - ui.px(6));
  const float middle = at.y + ui.px(19);
  const Bar bar{{at.x + ui.px(6), middle - ui.px(3)}, {at.x + width, middle + ui.px(3)}, start, end};
  ImGui::SetCursorScreenPos({bar.low.x - ui.px(6), middle - ui.px(11)});
  ImGui::InvisibleButton("timeline", {bar.high.x - bar.low.x + ui.px(12), ui.px(22)});
  ui.note("timeline");
  ui.places["timeline"] = {bar.low.x, bar.low.y, bar.high.x, bar.high.y};
  if (ImGui::IsItemActive()) {
    state.playback.playing = false;
    state.playback.t = bar.t(ImGui::GetIO().MousePos.x);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = bar.x(state.playback.t);
  list.AddRectFilled(bar.low, bar.high, ui.color(ui.theme.rule), ui.px(3));
  list.AddRectFilled(bar.low, {x, bar.high.y}, ui.color(ui.theme.accent), ui.px(3));
  draw_events(ui, state, bar);
  const bool held = ImGui::IsItemActive() || ImGui::IsItemHovered();
  list.AddCircleFilled({x, middle}, ui.px(held ? 8 : 7), ui.color(ui.theme.accent));
  list.AddCircleFilled({x, middle}, ui.px(3), ui.color(ui.theme.window));
}

}  // namespace

void draw_timeline(Ui& ui, PanelState& state) {
  if (!state.shown) return;
  const Trajectory& trajectory = state.shown->simulation.trajectory;
  const double start = trajectory.start_time(), end = trajectory.end_time();
  const float top = ImGui::GetCursorPosY();
  ImGui::SetCursorPosY(top + ui.px(8));
  draw_controls(ui, state, start, end);
  ImGui::SameLine(0, ui.px(14));
  char text[64];
  // As many decimals as tell a thousandth of the run, some more than its pictures have.
  const double span = end - start, fine = span > 0 ? std::ceil(3 - std::log10(span)) : 3;
  const int decimals = static_cast<int>(std::clamp(fine, span < 0.5 ? 5.0 : 3.0, 12.0));
  const float x = ImGui::GetCursorPosX();
  ImGui::PushFont(ui.bold);
  std::snprintf(text, sizeof text, "t = %.*f s", decimals, end);
  const float room = std::max(ui.px(104), ImGui::CalcTextSize(text).x + ui.px(14));
  std::snprintf(text, sizeof text, "t = %.*f s", decimals, state.playback.t);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  ui.note("time");
  ImGui::PopFont();
  ImGui::SetCursorPos({x + room, top});
  draw_bar(ui, state, start, end);
}

}  // namespace unfurl
