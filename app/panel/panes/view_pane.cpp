// SPDX-License-Identifier: BSD-3-Clause
// The centre: the 3-D view, what the mouse does in it, and what lies over it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "app/panel/document/build_edits.hpp"
#include "app/panel/panes/panes.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "render/scene/camera_path.hpp"
#include "render/scene/view.hpp"

namespace unfurl {

namespace {

struct Frame {  // of the view [pixels]
  ImVec2 low, size;
  float x() const { return ImGui::GetIO().MousePos.x - low.x; }  // of the pointer in it
  float y() const { return ImGui::GetIO().MousePos.y - low.y; }
};

void steer(PanelState& state, const SceneView& view, const Frame& frame) {
  const ImGuiIO& io = ImGui::GetIO();
  const OrbitCamera now = state.orbit ? *state.orbit : view.framed();
  const bool moved = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
  if (ImGui::IsItemActive() && moved && state.grabbed.empty()) {
    const bool pan = io.KeyShift || ImGui::IsMouseDown(1) || ImGui::IsMouseDown(2);
    state.orbit = (pan ? panned : orbited)(now, io.MouseDelta.x, io.MouseDelta.y, frame.size.y);
  }
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const Vec3f along = ray_through(view.camera(state), frame.x(), frame.y(), frame.size.x, frame.size.y);
    state.orbit = zoomed(now, io.MouseWheel, along, view.radius());
  }
}

// What the pointer means in space: a point of the plane through `through` [m of the scene]; none where the
// line of sight runs along it.
std::optional<Vec3> point_in_plane(const PanelState& state, const SceneView& view, const Frame& frame,
                                   const Vec3& through, int axis) {
  const PickView pick = view.pick_view(state);
  const Camera& camera = pick.camera;
  const Vec3f forward = (camera.target - camera.eye).normalized();
  Vec3f eye = camera.eye, along = ray_through(camera, frame.x(), frame.y(), frame.size.x, frame.size.y);
  if (camera.parallel_height > 0) {  // rays are parallel: from where the pointer's is in the picture's plane
    const Vec3f right = forward.cross(camera.up).normalized(), up = right.cross(forward);
    const float metres = camera.parallel_height / frame.size.y;
    eye +=
        right * (frame.x() - 0.5f * frame.size.x) * metres - up * (frame.y() - 0.5f * frame.size.y) * metres;
    along = forward;
  }
  const Mat3 back = pick.upright.transpose();
  const Vec3 from = back * eye.cast<double>() + pick.origin, way = back * along.cast<double>();
  const Vec3 normal = axis < 0 ? Vec3(back * forward.cast<double>()) : Vec3(Vec3::Unit(axis));
  const double slope = way.dot(normal);
  if (std::abs(slope) < 1e-3) return std::nullopt;
  const double far = (through - from).dot(normal) / slope;
  return far > 0 ? std::optional<Vec3>(from + far * way) : std::nullopt;
}

std::optional<Vec3> place_of_node(const PanelState& state, const std::string& name) {
  const Trajectory& trajectory = state.shown->simulation.trajectory;
  const auto& nodes = trajectory.structure().node_copies;
  const auto at = std::find_if(nodes.begin(), nodes.end(), [&](const NodeCopy& n) { return n.name == name; });
  if (at == nodes.end()) return std::nullopt;
  const VectorXd whole = state.pose ? *state.pose : trajectory.positions_at(state.playback.t);
  return Vec3(whole.segment<3>(3 * (at - nodes.begin())));
}

// A node that is held goes where the pointer goes, as far as it can.
void lead_node(PanelState& state, const SceneView& view, const Frame& frame) {
  const ImGuiIO& io = ImGui::GetIO();
  if (state.tool == Tool::read) return;
  if (ImGui::IsItemActivated() && ImGui::IsMouseDown(0) && state.hovered.kind == Selection::Kind::node &&
      !io.KeyShift)
    state.grabbed = state.hovered.name;
  if (state.grabbed.empty()) return;
  if (!ImGui::IsItemActive()) {
    state.grabbed.clear();
    state.history.end_gesture();
    return;
  }
  const auto place = place_of_node(state, state.grabbed);
  if (!place || (io.MouseDelta.x == 0 && io.MouseDelta.y == 0)) return;
  const bool build = state.tool == Tool::build;
  const auto target = point_in_plane(state, view, frame, *place, build ? state.grid.plane : -1);
  if (!target) return;
  state.intents.emplace_back([build, node = state.grabbed, to = *target](LiveSession& s) {
    if (build)
      s.move_node(node, to);
    else
      s.pull(node, to);
  });
}

// Clicks of a builder: twice where nothing is, a node; with Shift on another node, a rod.
void click_to_build(PanelState& state, const SceneView& view, const Frame& frame) {
  if (state.tool != Tool::build || !ImGui::IsItemHovered()) return;
  const bool free = state.hovered.kind == Selection::Kind::none;
  if (free && ImGui::IsMouseDoubleClicked(0)) {
    const int plane = state.grid.plane;
    const std::vector<Vec3> places = places_of(state.shown->simulation.trajectory.structure());
    const Vec3 usual = plane >= 0 && in_plane_across(plane, places) ? places.front() : Vec3::Zero();
    const Vec3 through = place_of_node(state, state.selected.name).value_or(usual);
    if (const auto place = point_in_plane(state, view, frame, through, plane))
      state.intents.emplace_back([to = *place](LiveSession& s) { s.add_node(to); });
  }
  if (ImGui::GetIO().KeyShift && ImGui::IsMouseClicked(0) && state.hovered.kind == Selection::Kind::node &&
      state.selected.kind == Selection::Kind::node)
    state.intents.emplace_back(
        [a = state.selected.name, b = state.hovered.name](LiveSession& s) { s.connect(a, b); });
}

void point_at(const Ui& ui, PanelState& state, const SceneView& view, const Frame& frame) {
  state.hovered = {};
  if (!ImGui::IsItemHovered()) return;
  const bool dragging = ImGui::IsMouseDragging(0) || ImGui::IsMouseDragging(1) || ImGui::IsMouseDragging(2);
  if (!dragging)
    state.hovered = pick(*state.shown, state.playback.t, view.pick_view(state), frame.x(), frame.y(),
                         ui.px(9), state.pose ? &*state.pose : nullptr);
  const ImVec2 way = ImGui::GetMouseDragDelta(0, 0);
  if (ImGui::IsMouseReleased(0) && std::hypot(way.x, way.y) < ui.px(4)) state.selected = state.hovered;
}

// The pose that a hand leads the structure to, over the run's own.
void draw_pose(const Ui& ui, const PanelState& state, const SceneView& view, const Frame& frame) {
  if (!state.pose) return;
  const Structure& structure = state.shown->simulation.trajectory.structure();
  const PickView pick = view.pick_view(state);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(frame.low, {frame.low.x + frame.size.x, frame.low.y + frame.size.y},
                     ui.color(ui.theme.window, 0.55f));
  const auto at = [&](int node) {
    const Vec3 place = pick.upright * (state.pose->segment<3>(3 * node) - pick.origin);
    return project(pick.camera, pick.width, pick.height, place.cast<float>());
  };
  for (const RodCopy& rod : structure.rod_copies) {
    const Vec3f a = at(rod.a), b = at(rod.b);
    if (a.z() <= 0 || b.z() <= 0) continue;
    list.AddLine({frame.low.x + a.x(), frame.low.y + a.y()}, {frame.low.x + b.x(), frame.low.y + b.y()},
                 ui.color(ui.theme.accent), ui.px(4));
  }
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const Vec3f p = at(static_cast<int>(i));
    const ImVec2 center(frame.low.x + p.x(), frame.low.y + p.y());
    if (p.z() <= 0) continue;
    list.AddCircleFilled(center, ui.px(5), ui.color(ui.theme.window));
    list.AddCircle(center, ui.px(5), ui.color(ui.theme.accent), 0, ui.px(2));
  }
}

// Its name beside the pointer.
void name_hovered(const Ui& ui, const PanelState& state) {
  if (state.hovered.kind == Selection::Kind::none) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  text_on_ground(ui, {mouse.x + ui.px(14), mouse.y - ImGui::GetFontSize() - ui.px(8)},
                 state.hovered.name.c_str(), 0.92f);
}

void mark(const Ui& ui, const PanelState& state, const SceneView& view, const Frame& frame,
          const Selection& selection, ImU32 color) {
  if (state.pose) return;  // the run's own pose is not what is looked at
  const PickedPlace place = place_of(selection, *state.shown, state.playback.t, view.pick_view(state));
  if (!place.found || place.a.z() <= 0 || place.b.z() <= 0) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 a(frame.low.x + place.a.x(), frame.low.y + place.a.y());
  const ImVec2 b(frame.low.x + place.b.x(), frame.low.y + place.b.y());
  if (selection.kind == Selection::Kind::rod) list.AddLine(a, b, color, ui.px(3));
  list.AddCircle(a, ui.px(7), color, 0, ui.px(2));
  list.AddCircle(b, ui.px(7), color, 0, ui.px(2));
}

// Where nodes are, those too from which no rod begins yet: what a builder points at.
void mark_nodes(const Ui& ui, const PanelState& state, const SceneView& view, const Frame& frame) {
  if (state.tool != Tool::build || state.pose) return;
  const Trajectory& trajectory = state.shown->simulation.trajectory;
  const auto& copies = trajectory.structure().node_copies;
  const auto& nodes = state.shown->scene.custom.nodes;  // before those within rods that are cut
  const VectorXd whole = trajectory.positions_at(state.playback.t);
  const PickView pick = view.pick_view(state);
  for (std::size_t i = 0; i < std::min(nodes.size(), copies.size()); ++i) {
    if (copies[i].name != nodes[i].name) continue;
    const Vec3 place = pick.upright * (whole.segment<3>(3 * static_cast<Index>(i)) - pick.origin);
    const Vec3f at = project(pick.camera, pick.width, pick.height, place.cast<float>());
    if (at.z() <= 0) continue;
    const ImVec2 center(frame.low.x + at.x(), frame.low.y + at.y());
    ImDrawList& list = *ImGui::GetWindowDrawList();  // seen on what is dark and on what is light
    list.AddCircleFilled(center, ui.px(4), ui.color(ui.theme.window));
    list.AddCircle(center, ui.px(4), ui.color(ui.theme.text), 0, ui.px(1.5f));
  }
}

// What is built is framed at its start, and then stays where it is while parts are added.
void frame_for_building(PanelState& state, const SceneView& view) {
  if (state.tool == Tool::build && state.base.kind == "custom") {
    if (!state.orbit && simulated_part(state.shown->document) == simulated_part(state.history.now()))
      state.orbit = state.build_view = view.framed_start();
  } else if (state.build_view) {
    if (state.orbit == state.build_view) state.orbit.reset();
    state.build_view.reset();
  }
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
  if (state.pose) return;  // they are of the run
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

// The older run stays in sight, dimmed where the newer one takes its time: until then nothing is drawn twice.
void draw_pending(Ui& ui, const PanelState& state, const Frame& frame) {
  if (!state.simulation.late) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 high(frame.low.x + frame.size.x, frame.low.y + frame.size.y);
  const double done = std::clamp(state.simulation.progress, 0.0, 1.0);
  const bool of_this = state.shown && state.shown->coarse && state.shown->document == state.history.now();
  if (!of_this) list.AddRectFilled(frame.low, high, ui.color(ui.theme.window, 0.45f));
  const float width = static_cast<float>(std::max(done, 0.02)) * frame.size.x;
  list.AddRectFilled({frame.low.x, high.y - ui.px(4)}, {frame.low.x + width, high.y},
                     ui.color(ui.theme.accent));
  char text[96];
  std::snprintf(text, sizeof text, "%s %.0f %%", state.simulation.doing.c_str(), 100 * done);
  ui.places["progress"] = text_on_ground(ui, {frame.low.x + ui.px(14), high.y - ui.px(26)}, text, 0.85f);
}

// Which run it is: its title, what became of it, the first of its warnings, in the view's upper left corner.
struct StateLine {
  std::string title, text, warned;
  ImVec2 at;           // of the title, from the view's corner [pixels]
  float text_top = 0;  // of the text and of the warning
  float warned_top = 0;
  plot::Rect ground;  // below all of them
};

StateLine state_line(const Ui& ui, const LiveRun& run, std::string text, float width) {
  const float pad = ui.px(7), room = width - ui.px(40);
  StateLine line;
  ImGui::PushFont(ui.bold);  // that of the title: it is wider than the other
  line.title = shortened(run.scene.title, room);
  ImGui::PopFont();
  line.text = std::move(text);
  line.warned = shortened(warning_sentence(run), room);
  line.at = {ui.px(17), ui.px(52)};
  const ImVec2 size = ImGui::CalcTextSize(line.text.c_str(), nullptr, false, room);
  const float titled = ui.bold->CalcTextSizeA(ui.bold->FontSize, FLT_MAX, 0, line.title.c_str()).x;
  const float wide = std::max({size.x, titled, ImGui::CalcTextSize(line.warned.c_str()).x});
  line.text_top = line.at.y + ui.bold->FontSize + ui.px(4);
  line.warned_top = line.text_top + size.y + ui.px(2);
  const float end = line.warned.empty() ? line.text_top + size.y : line.warned_top + ui.regular->FontSize;
  line.ground = {line.at.x - pad, line.at.y - pad, line.at.x + wide + pad, end + pad};
  return line;
}

// On a ground of its own: the structure may be behind it.
void draw_state_line(Ui& ui, const PanelState& state, const SceneView& view, const Frame& frame) {
  const LiveRun& run = *state.shown;
  std::string text = state_sentence(run);
  if (state.playback.playing && state.frames_per_second > 0) {
    char rate[40];
    std::snprintf(rate, sizeof rate, ", %.0f frames/s", state.frames_per_second);
    text.insert(std::min(text.find('\n'), text.size()), rate);
  }
  if (const std::string note = view.scale_note(); !note.empty()) text += "\n" + note;
  const StateLine line = state_line(ui, run, text, frame.size.x);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto place = [&](double x, double y) {
    return ImVec2(frame.low.x + static_cast<float>(x), frame.low.y + static_cast<float>(y));
  };
  const ImVec2 low = place(line.ground.x0, line.ground.y0), high = place(line.ground.x1, line.ground.y1);
  list.AddRectFilled(low, high, ui.color(ui.theme.window, 0.72f), ui.px(5));
  list.AddText(ui.bold, ui.bold->FontSize, place(line.at.x, line.at.y), ui.color(ui.theme.text),
               line.title.c_str());
  const bool failed = run.simulation.status == RunStatus::failed;
  list.AddText(ui.regular, ui.regular->FontSize, place(line.at.x, line.text_top),
               ui.color(failed ? ui.theme.error : ui.theme.dim), line.text.c_str(), nullptr,
               frame.size.x - ui.px(40));
  list.AddText(place(line.at.x, line.warned_top), ui.color(ui.theme.warning), line.warned.c_str());
  ui.places["state line"] = {low.x, low.y, high.x, high.y};
}

void choose_preset(PanelState& state, const SceneView& view, ViewPreset preset) {
  const float aspect = static_cast<float>(view.width()) / static_cast<float>(std::max(1, view.height()));
  state.orbit = preset_view(preset, view.center(), view.radius(), aspect, view.framed().field_of_view);
}

// Of the picture's keys those that one changes often.
constexpr std::string_view quick_rows[] = {"render.look", "render.colour_by", "render.ghosts",
                                           "render.node_labels", "render.rod_labels"};

void draw_view_options(Ui& ui, PanelState& state, const SceneView& view) {
  const plot::Rect& above = ui.places.at("view options");
  ImGui::SetNextWindowPos({static_cast<float>(above.x0), static_cast<float>(above.y1) + ui.px(4)});
  ImGui::SetNextWindowSizeConstraints({ui.px(320), 0}, {ui.px(320), FLT_MAX});
  if (!ImGui::BeginPopup("view options")) return;
  constexpr std::pair<const char*, ViewPreset> presets[] = {{"Front", ViewPreset::front},
                                                            {"Side", ViewPreset::side},
                                                            {"Top", ViewPreset::top},
                                                            {"Corner", ViewPreset::three_quarter}};
  for (const auto& [label, preset] : presets) {
    if (preset != ViewPreset::front) ImGui::SameLine(0, ui.px(4));
    if (button(ui, std::string("view ") + label, label, "look from here")) choose_preset(state, view, preset);
  }
  const auto use = [&](const char* key, const char* label, const char* help, bool only) {
    if (button(ui, key, label, help, !only || state.orbit || moves_camera(state.picture)))
      state.intents.emplace_back([only](LiveSession& s) { s.use_view(only); });
  };
  use("use view", "Use this view", "azimuth, elevation and zoom go into the scene, and into every export (V)",
      true);
  ImGui::SameLine(0, ui.px(4));
  use("camera key", "Camera key here", "the film's camera is here at the present time (K)", false);
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

void draw_build_options(Ui& ui, PanelState& state, const Frame& frame) {
  BuildGrid& grid = state.grid;
  ImGui::SetCursorScreenPos({frame.low.x + ui.px(10), frame.low.y + frame.size.y - ui.px(62)});
  const auto choose = [&](const char* key, const char* const* names, int count, int first, int& value) {
    ImGui::SetNextItemWidth(ui.px(112));
    int chosen = value - first;
    if (ImGui::Combo((std::string("##") + key).c_str(), &chosen, names, count)) value = chosen + first;
    ui.note(key);
    ImGui::SameLine(0, ui.px(6));
  };
  constexpr const char* planes[] = {"view plane", "across x", "across y", "across z"};
  constexpr const char* mirrors[] = {"no mirror", "mirror x = 0", "mirror y = 0", "mirror z = 0"};
  constexpr const char* steps[] = {"no grid", "grid 0.01 m", "grid 0.1 m", "grid 0.5 m", "grid 1 m"};
  constexpr double sizes[] = {0, 0.01, 0.1, 0.5, 1};
  int step = static_cast<int>(std::find(std::begin(sizes), std::end(sizes), grid.step) - std::begin(sizes));
  choose("build plane", planes, 4, -1, grid.plane);
  choose("build grid", steps, 5, 0, step);
  grid.step = sizes[std::clamp(step, 0, 4)];
  choose("build mirror", mirrors, 4, -1, grid.mirror);
  ImGui::Checkbox("lengths follow", &grid.follow);
  ui.note("build follow");
  tooltip(ui, "rods take the distance of their nodes; else they keep their lengths and the rest moves along");
  ImGui::SameLine(0, ui.px(6));
  if (button(ui, "remove part", "Delete", "what is selected (Del)",
             state.selected.kind != Selection::Kind::none))
    state.intents.emplace_back(&LiveSession::remove_selected);
}

// What the tool that is taken does: above what it lets choose, and above the row of the progress and the
// legend.
void draw_tool(Ui& ui, PanelState& state, const Frame& frame) {
  if (state.tool == Tool::read) return;
  const bool build = state.tool == Tool::build;
  if (build) draw_build_options(ui, state, frame);
  const char* hint = build ? "Build: click twice for a node, drag it, Shift click from node to node for a rod"
                           : "Pull: drag a node; drives let go. Esc: back to the run";
  const float room = frame.size.x - ui.px(28), above = ui.px(build ? 68 : 34);
  const float tall = ImGui::CalcTextSize(hint, nullptr, false, room).y;
  const ImVec2 at(frame.low.x + ui.px(14), frame.low.y + frame.size.y - above - tall);
  ui.places["tool hint"] = text_on_ground(ui, at, hint, 0.85f, room);
}

void draw_view_buttons(Ui& ui, PanelState& state, const SceneView& view, const Frame& frame) {
  ImGui::SetCursorScreenPos({frame.low.x + ui.px(10), frame.low.y + ui.px(10)});
  if (button(ui, "view options", "View\u2026", "where from, the film's camera, what is shown"))
    ImGui::OpenPopup("view options");
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "frame", "Frame", "see the whole motion (F)")) state.orbit.reset();
  // What a narrow view has no room for is reached by its key, or by the palette.
  const auto has_room = [&](const char* label) {
    const float wide = ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x + ui.px(14);
    return ImGui::GetItemRectMax().x + wide < frame.low.x + frame.size.x;
  };
  const auto tool = [&](const char* key, const char* label, const char* help, Tool which) {
    if (!has_room(label)) return;
    ImGui::SameLine(0, ui.px(4));
    const bool is = state.tool == which;
    if (is) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (button(ui, key, label, help))
      state.intents.emplace_back([which](LiveSession& s) { s.take_tool(which); });
    if (is) ImGui::PopStyleColor();
  };
  tool("tool pull", "Pull", "take nodes by hand: what the mechanism allows (G)", Tool::pull);
  tool("tool build", "Build", "add, drag, connect, delete nodes and rods of a custom scene (B)", Tool::build);
  if (has_room("Wiggle")) {
    ImGui::SameLine(0, ui.px(4));
    if (button(ui, "wiggle", "Wiggle", "each free motion of this pose, one after the other (W)"))
      state.intents.emplace_back(&LiveSession::wiggle);
  }
  draw_view_options(ui, state, view);
}

}  // namespace

// With a line for what is not to scale, whether there is something or not: it depends on the camera.
CornerRoom heading_room(const Ui& ui, const PanelState& state, float width, float height) {
  if (!state.shown || width < 1 || height < 1) return {};
  const plot::Rect ground = state_line(ui, *state.shown, state_sentence(*state.shown) + "\n ", width).ground;
  const double gap = ui.px(6);
  return {(ground.x1 + gap) / width, (ground.y1 + gap) / height};
}

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
  frame_for_building(state, view);
  point_at(ui, state, view, frame);
  lead_node(state, view, frame);
  steer(state, view, frame);
  click_to_build(state, view, frame);
  draw_pose(ui, state, view, frame);
  mark(ui, state, view, frame, state.selected, ui.color(ui.theme.accent));
  if (!(state.hovered == state.selected))
    mark(ui, state, view, frame, state.hovered, ui.color(ui.theme.accent, 0.6f));
  name_hovered(ui, state);
  draw_readings(ui, state, view, frame);
  draw_state_line(ui, state, view, frame);
  mark_nodes(ui, state, view, frame);
  if (!state.right_open)  // on the left below the title: the legend stands at the bottom
    draw_comparison(ui, state,
                    {frame.low.x + ui.px(10), static_cast<float>(ui.places.at("state line").y1) + ui.px(6)},
                    frame.size.x - ui.px(20));
  draw_view_buttons(ui, state, view, frame);
  draw_tool(ui, state, frame);
  draw_pending(ui, state, frame);
}

}  // namespace unfurl
