// SPDX-License-Identifier: BSD-3-Clause
// The centre: the 3-D view, what the mouse does in it, and what lies over it.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/panel/panes/panes.hpp"
#include "app/panel/runs/comparison.hpp"
#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

namespace {

struct Frame {  // of the view [pixels]
  ImVec2 low, size;
};

void steer(PanelState& state, const SceneView& view, const Frame& frame) {
  const ImGuiIO& io = ImGui::GetIO();
  const OrbitCamera now = state.orbit ? *state.orbit : view.framed();
  const bool moved = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
  if (ImGui::IsItemActive() && moved) {
    const bool pan = io.KeyShift || ImGui::IsMouseDown(1) || ImGui::IsMouseDown(2);
    state.orbit = (pan ? panned : orbited)(now, io.MouseDelta.x, io.MouseDelta.y, frame.size.y);
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const Vec3f along = ray_through(view.camera(state), io.MousePos.x - frame.low.x,
                                    io.MousePos.y - frame.low.y, frame.size.x, frame.size.y);
    state.orbit = zoomed(now, io.MouseWheel, along);
  }
}

void point_at(const Ui& ui, PanelState& state, const SceneView& view, const Frame& frame) {
  const ImGuiIO& io = ImGui::GetIO();
  state.hovered = {};
  if (!ImGui::IsItemHovered()) return;
  const bool dragging = ImGui::IsMouseDragging(0) || ImGui::IsMouseDragging(1) || ImGui::IsMouseDragging(2);
  if (!dragging)
    state.hovered = pick(*state.shown, state.playback.t, view.pick_view(state), io.MousePos.x - frame.low.x,
                         io.MousePos.y - frame.low.y, ui.px(9));
  const ImVec2 way = ImGui::GetMouseDragDelta(0, 0);
  if (ImGui::IsMouseReleased(0) && std::hypot(way.x, way.y) < ui.px(4)) state.selected = state.hovered;
}

void mark(const Ui& ui, const PanelState& state, const SceneView& view, const Frame& frame,
          const Selection& selection, ImU32 color) {
  const PickedPlace place = place_of(selection, *state.shown, state.playback.t, view.pick_view(state));
  if (!place.found || place.a.z() <= 0 || place.b.z() <= 0) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 a(frame.low.x + place.a.x(), frame.low.y + place.a.y());
  const ImVec2 b(frame.low.x + place.b.x(), frame.low.y + place.b.y());
  if (selection.kind == Selection::Kind::rod) list.AddLine(a, b, color, ui.px(3));
  list.AddCircle(a, ui.px(7), color, 0, ui.px(2));
  list.AddCircle(b, ui.px(7), color, 0, ui.px(2));
}

// Lines of text on a ground of their own, right-aligned values, in the upper right corner of the view; in the
// lower one where it would lie over the part that it is about.
void draw_box(const Ui& ui, const std::string& title, const std::vector<Reading>& rows, const Frame& frame,
              const std::vector<ImVec2>& part) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ui.regular->FontSize + ui.px(3), pad = ui.px(10), gap = ui.px(16);
  float label = 0, value = 0;
  for (const Reading& row : rows) {
    label = std::max(label, ImGui::CalcTextSize(row.label.c_str()).x);
    value = std::max(value, ImGui::CalcTextSize(row.value.c_str()).x);
  }
  ImGui::PushFont(ui.bold);
  const float width = std::max(label + gap + value, ImGui::CalcTextSize(title.c_str()).x) + 2 * pad;
  ImGui::PopFont();
  const float height = line * static_cast<float>(rows.size() + 1) + 2 * pad, margin = ui.px(12);
  const ImVec2 corner(frame.low.x + frame.size.x - margin, frame.low.y + margin);
  ImVec2 low(corner.x - width, corner.y);
  const bool over = std::any_of(part.begin(), part.end(), [&](const ImVec2& p) {
    return p.x > low.x - margin && p.y < low.y + height + margin;
  });
  const float legend = ui.px(44);  // below it
  if (over) low.y = std::max(low.y, frame.low.y + frame.size.y - height - legend);
  list.AddRectFilled(low, {corner.x, low.y + height}, ui.color(ui.theme.window, 0.92f), ui.px(6));
  list.AddRect(low, {corner.x, low.y + height}, ui.color(ui.theme.rule), ui.px(6));
  list.AddText(ui.bold, ui.bold->FontSize, {low.x + pad, low.y + pad}, ui.color(ui.theme.text),
               title.c_str());
  float y = low.y + pad + line;
  for (const Reading& row : rows) {
    const float wide = ImGui::CalcTextSize(row.value.c_str()).x;
    list.AddText({low.x + pad, y}, ui.color(ui.theme.dim), row.label.c_str());
    list.AddText({corner.x - pad - wide, y}, ui.color(ui.theme.text), row.value.c_str());
    y += line;
  }
}

void draw_readings(const Ui& ui, const PanelState& state, const SceneView& view, const Frame& frame) {
  const Selection& selection = state.hovered.kind != Selection::Kind::none ? state.hovered : state.selected;
  const auto rows = readings(selection, *state.shown, state.playback.t);
  if (rows.empty()) return;
  const std::string kind = selection.kind == Selection::Kind::rod ? "rod " : "node ";
  const PickedPlace place = place_of(selection, *state.shown, state.playback.t, view.pick_view(state));
  std::vector<ImVec2> part;
  for (const Vec3f& end : {place.a, place.b})
    if (place.found) part.emplace_back(frame.low.x + end.x(), frame.low.y + end.y());
  draw_box(ui, kind + selection.name, rows, frame, part);
}

// The older run stays in sight, dimmed, while the newer one is made.
void draw_pending(const Ui& ui, const PanelState& state, const Frame& frame) {
  if (!state.simulation.running) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 high(frame.low.x + frame.size.x, frame.low.y + frame.size.y);
  const double done = std::clamp(state.simulation.progress, 0.0, 1.0);
  list.AddRectFilled(frame.low, high, ui.color(ui.theme.window, 0.45f));
  const float width = static_cast<float>(std::max(done, 0.02)) * frame.size.x;
  list.AddRectFilled({frame.low.x, high.y - ui.px(4)}, {frame.low.x + width, high.y},
                     ui.color(ui.theme.accent));
  char text[96];
  std::snprintf(text, sizeof text, "%s %.0f %%", state.simulation.doing.c_str(), 100 * done);
  list.AddText({frame.low.x + ui.px(12), high.y - ui.px(26)}, ui.color(ui.theme.text), text);
}

void draw_state_line(const Ui& ui, const PanelState& state, const Frame& frame, bool dark_ground) {
  const LiveRun& run = *state.shown;
  std::string text = run.scene.title;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 at(frame.low.x + ui.px(14), frame.low.y + ui.px(46));
  const ImVec4 ink = dark_ground ? ImVec4(0.92f, 0.94f, 0.96f, 1) : ImVec4(0.12f, 0.15f, 0.18f, 1);
  list.AddText(ui.bold, ui.bold->FontSize, at, ui.color(ink), text.c_str());
  std::string line = std::string(to_string(run.simulation.status));
  char facts[160];
  std::snprintf(facts, sizeof facts, " at %.4g s, %ld steps, %.3g s of CPU time",
                run.simulation.trajectory.end_time(), run.simulation.steps, run.simulation.cpu_s);
  if (state.playback.playing && state.frames_per_second > 0) {
    const std::size_t end = std::char_traits<char>::length(facts);
    std::snprintf(facts + end, sizeof facts - end, ", %.0f frames/s", state.frames_per_second);
  }
  const bool failed = run.simulation.status == RunStatus::failed;
  line = failed ? "the solver failed " + run.simulation.message : line + facts;
  const float room = frame.low.x + frame.size.x - at.x - ui.px(14);
  list.AddText(ui.regular, ui.regular->FontSize, {at.x, at.y + ui.bold->FontSize + ui.px(4)},
               ui.color(failed ? ui.theme.error : ink, failed ? 1.0f : 0.75f), line.c_str(), nullptr,
               std::max(room, ui.px(60)));
}

// A and B side by side, in the lower left corner.
void draw_comparison(Ui& ui, const PanelState& state, const Frame& frame) {
  if (!state.pinned) return;
  const auto rows = compare(*state.pinned, *state.shown, point_of(state.trade, *state.pinned),
                            point_of(state.trade, *state.shown));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ui.regular->FontSize + ui.px(3), pad = ui.px(10);
  const float columns[] = {ui.px(118), ui.px(110), ui.px(110), ui.px(92)};
  float width = 2 * pad;
  for (const float column : columns) width += column;
  const float height = 2 * pad + line * static_cast<float>(rows.size() + 1);
  const ImVec2 low(frame.low.x + ui.px(12), frame.low.y + frame.size.y - height - ui.px(12));
  list.AddRectFilled(low, {low.x + width, low.y + height}, ui.color(ui.theme.window, 0.92f), ui.px(6));
  list.AddRect(low, {low.x + width, low.y + height}, ui.color(ui.theme.rule), ui.px(6));
  float y = low.y + pad;
  const auto draw = [&](const ComparisonRow& row, const ImVec4& ink_a, const ImVec4& ink_b) {
    const std::pair<const std::string*, const ImVec4*> cells[] = {
        {&row.label, &ui.theme.dim}, {&row.a, &ink_a}, {&row.b, &ink_b}, {&row.change, &ui.theme.text}};
    float right = low.x + pad;
    for (int i = 0; i < 4; ++i) {
      right += columns[i];
      const float wide = ImGui::CalcTextSize(cells[i].first->c_str()).x;
      list.AddText({i == 0 ? right - columns[0] : right - wide, y}, ui.color(*cells[i].second),
                   cells[i].first->c_str());
    }
    y += line;
  };
  draw({"", "A (pinned)", "B (now)", "B/A"}, ui.theme.curve_a, ui.theme.curve_b);
  for (const ComparisonRow& row : rows) draw(row, ui.theme.text, ui.theme.text);
  ui.places["comparison"] = {low.x, low.y, low.x + width, low.y + height};
}

void choose_preset(PanelState& state, const SceneView& view, ViewPreset preset) {
  const float aspect = static_cast<float>(view.width()) / static_cast<float>(std::max(1, view.height()));
  state.orbit = preset_view(preset, view.center(), view.radius(), aspect, view.framed().field_of_view);
}

// Of the picture's keys those that one changes often.
constexpr std::string_view quick_rows[] = {"render.look", "render.colour_by", "render.ghosts",
                                           "render.node_labels", "render.rod_labels"};

void draw_view_buttons(Ui& ui, PanelState& state, const SceneView& view, const Frame& frame) {
  ImGui::SetCursorScreenPos({frame.low.x + ui.px(10), frame.low.y + ui.px(10)});
  if (button(ui, "frame", "Frame", "see the whole motion (F)")) state.orbit.reset();
  constexpr std::pair<const char*, ViewPreset> presets[] = {
      {"Front", ViewPreset::front}, {"Side", ViewPreset::side}, {"Top", ViewPreset::top}};
  for (const auto& [label, preset] : presets) {
    ImGui::SameLine(0, ui.px(4));
    if (button(ui, std::string("view ") + label, label, "look from here")) choose_preset(state, view, preset);
  }
  ImGui::SameLine(0, ui.px(12));
  if (button(ui, "view options", "View", "what the view shows")) ImGui::OpenPopup("view options");
  ImGui::SetNextWindowSizeConstraints({ui.px(300), 0}, {ui.px(300), FLT_MAX});
  if (!ImGui::BeginPopup("view options")) return;
  for (const ParamSection& section : state.sections)
    for (const ParamRow& row : section.rows)
      if (std::find(std::begin(quick_rows), std::end(quick_rows), row.key) != std::end(quick_rows))
        draw_row(ui, state, row);
  ImGui::Checkbox("loads as arrows", &state.view.loads);
  ui.note("view.loads");
  ImGui::Checkbox("title and time of the film", &state.view.labels);
  ui.note("view.labels");
  ImGui::Checkbox("the pinned run as a ghost", &state.view.ghost);
  ui.note("view.ghost");
  ImGui::EndPopup();
}

}  // namespace

void draw_view_pane(Ui& ui, PanelState& state, SceneView& view) {
  const Frame frame{ImGui::GetWindowPos(), ImGui::GetWindowSize()};
  if (!view.ready()) {
    draw_pending(ui, state, frame);
    return;
  }
  ImGui::SetCursorScreenPos(frame.low);
  ImGui::SetItemAllowOverlap();
  ImGui::InvisibleButton("view", frame.size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  ImGui::SetItemAllowOverlap();
  ui.note("view");
  steer(state, view, frame);
  point_at(ui, state, view, frame);
  mark(ui, state, view, frame, state.selected, ui.color(ui.theme.accent));
  if (!(state.hovered == state.selected))
    mark(ui, state, view, frame, state.hovered, ui.color(ui.theme.accent, 0.6f));
  draw_readings(ui, state, view, frame);
  draw_state_line(ui, state, frame, view.dark_ground());
  draw_comparison(ui, state, frame);
  draw_view_buttons(ui, state, view, frame);
  draw_pending(ui, state, frame);
}

}  // namespace unfurl
