// SPDX-License-Identifier: BSD-3-Clause
// The right pane's other page: a small study of the scene that is shown, run beside the window.
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/panel/panes/panes.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/integrators/integrator.hpp"
#include "core/study/table.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {

namespace {

using StudyKind = StudyRequest::Kind;

// A label, then the widget at the same place in every row.
void label_row(const Ui& ui, const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ui.theme.dim, "%s", label);
  ImGui::SameLine(ImGui::GetCursorStartPos().x + ui.px(104));
  ImGui::SetNextItemWidth(-1);
}

void number_row(Ui& ui, PanelState& state, const char* label, const char* key, double& value,
                const std::string& help) {
  label_row(ui, label);
  char text[256];
  std::snprintf(text, sizeof text, "%s", short_number(value, 6).c_str());
  const std::string field = std::string("##") + key;
  const ImGuiID id = ImGui::GetID(field.c_str());
  const bool active = ImGui::GetActiveID() == id;  // in the frame in which Esc ends that, too
  ImGui::InputText(field.c_str(), text, sizeof text, ImGuiInputTextFlags_AutoSelectAll);
  if (active) {
    const Variables variables(state.base.variables.begin(), state.base.variables.end());
    Typing typing{ui.typed, variables};
    take_typed(id, text, value, typing);
    const std::string about = std::string(label) + ": ";
    if (!typing.problem.empty())
      state.message = about + typing.problem;
    else if (state.message.starts_with(about))
      state.message.clear();
  }
  ui.note(key);
  tooltip(ui, help);
}

// Two in a row: the figure below wants the room.
void choose_methods(Ui& ui, StudyRequest& request) {
  auto& chosen = request.methods;
  const float half = ImGui::GetCursorStartPos().x + 0.5f * ImGui::GetContentRegionAvail().x;
  bool second = false;
  for (const Method& method : methods()) {
    if (second) ImGui::SameLine(half);
    second = !second;
    const std::string name(method.name);
    const auto at = std::find(chosen.begin(), chosen.end(), name);
    bool is = at != chosen.end();
    if (ImGui::Checkbox(name.c_str(), &is)) {
      if (is)
        chosen.push_back(name);
      else
        chosen.erase(at);
    }
    ui.note("study method " + name);
    tooltip(ui, std::string(method.help));
  }
}

void choose_precision(Ui& ui, PanelState& state, StudyRequest& request) {
  choose_methods(ui, request);
  number_row(ui, state, "largest step", "study largest", request.largest_step, "of the ladder [s]");
  number_row(ui, state, "smallest step", "study smallest", request.smallest_step, "of the ladder [s]");
}

bool sweepable(const ParamRow& row) {
  return row.spec.kind == ParamKind::real || row.spec.kind == ParamKind::integer;
}

double as_number(const ParamValue& value) {
  if (const auto* whole = std::get_if<long>(&value)) return static_cast<double>(*whole);
  return std::get<double>(value);
}

// What the parameter's slider spans, rounded by the slider itself; about a usual value where it has none.
void choose_key(const ParamRow& row, StudyRequest& request) {
  const SliderRange range = slider_range(row);
  const double now = not_given(row.value) ? first_value(row) : as_number(row.value);
  request.key = row.key;
  request.from = std::max(range.low, now > 0 ? 0.5 * now : range.low);
  request.to = std::min(range.high, now > 0 ? 1.5 * now : range.high);
  if (row.spec.kind != ParamKind::integer) return;
  request.from = std::ceil(request.from);
  request.to = std::max(request.from + 1, std::floor(request.to));
  request.count = static_cast<int>(std::min(9.0, request.to - request.from + 1));
  request.to = request.from + request.count - 1;  // whole numbers all along
}

void choose_sweep(Ui& ui, PanelState& state, StudyRequest& request) {
  label_row(ui, "parameter");
  if (ImGui::BeginCombo("##study key", request.key.c_str(), ImGuiComboFlags_HeightLarge)) {
    for (const ParamSection& section : state.sections)
      for (const ParamRow& row : section.rows) {
        if (!sweepable(row) || row.key.starts_with("render.")) continue;
        if (ImGui::Selectable(row.key.c_str(), row.key == request.key)) choose_key(row, request);
        ui.note("study key=" + row.key);
      }
    ImGui::EndCombo();
  }
  ui.note("study key");
  number_row(ui, state, "from", "study from", request.from, "the parameter's first value");
  number_row(ui, state, "to", "study to", request.to, "the parameter's last value");
  label_row(ui, "points");
  ImGui::SliderInt("##points", &request.count, 2, 50);
  ui.note("study points");
  label_row(ui, "measure");
  if (!ImGui::BeginCombo("##measure", request.measure.c_str())) return;
  for (const NamedMeasure& measure : named_measures()) {
    const std::string name(measure.name);
    if (ImGui::Selectable(name.c_str(), name == request.measure)) request.measure = name;
    tooltip(ui, std::string(measure.help));
  }
  ImGui::EndCombo();
}

// The kind of study, and for a scene that was not studied before what to begin with.
void choose_kind(Ui& ui, PanelState& state, StudyRequest& request) {
  const char* names[] = {"speed against accuracy", "a measure over a parameter"};
  int kind = request.kind == StudyKind::sweep ? 1 : 0;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::Combo("##study kind", &kind, names, 2))
    request.kind = kind == 1 ? StudyKind::sweep : StudyKind::precision;
  ui.note("study kind");
  const SolverOptions& solver = state.base.solver;
  if (!(request.largest_step > 0)) {
    request.largest_step = 4 * solver.step;
    request.smallest_step = solver.step / 4;
    request.methods = {solver.method};
    if (solver.method != "rk4") request.methods.push_back("rk4");
  }
  if (!request.key.empty()) return;
  for (const ParamSection& section : state.sections)
    for (const ParamRow& row : section.rows)
      if (request.key.empty() && row.spec.kind == ParamKind::real) choose_key(row, request);
}

void draw_start(Ui& ui, PanelState& state) {
  const bool sound =
      state.problems.empty() &&
      (state.study.kind == StudyKind::sweep ? !state.study.key.empty() : !state.study.methods.empty());
  if (state.studying.running) {
    if (button(ui, "cancel study", "Cancel", "keep the points that there are"))
      state.intents.emplace_back(&LiveSession::stop_study);
    ImGui::SameLine();
    ImGui::ProgressBar(static_cast<float>(state.studying.progress), {-1, 0});
    ui.note("study progress");
  } else if (button(ui, "start study", "Start", "beside the window, by the code of the command below",
                    sound)) {
    state.intents.emplace_back(&LiveSession::start_study);
  }
  const std::string line = study_command(state.study, state.history.now());
  ImGui::SameLine(0, state.studying.running ? 0 : ui.px(8));
  if (!state.studying.running) {
    if (button(ui, "copy study", "Copy command", line)) {
      ImGui::SetClipboardText(line.c_str());
      const SceneDocument& now = state.history.now();
      if (now.path.empty() || state.own_file != OwnFile::same)
        state.message =
            "copied; save the scene that is shown as " + proposed_file(now) + " before: no file holds it";
    }
  } else {
    ImGui::NewLine();
  }
}

// What the mark under the pointer stands for.
void name_mark(const Ui& ui, const FigureCard& card, const PlacedFigure& place) {
  if (!ImGui::IsWindowHovered()) return;
  const Panel& panel = card.figure->panels.front();
  const plot::PanelLayout& layout = card.layout.panels.front();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  float nearest = ui.px(8);
  std::string text;
  for (const Curve& curve : panel.curves)
    for (std::size_t i = 0; curve.marker != Marker::none && i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
      const float dx = place.x(layout.x.scale(curve.x[i])) - mouse.x;
      const float dy = place.y(layout.y.scale(curve.y[i])) - mouse.y;
      if (std::hypot(dx, dy) >= nearest) continue;
      nearest = std::hypot(dx, dy);
      text = (curve.label.empty() ? "" : curve.label + "\n") + panel.x.label + ": " +
             plot::format_number(curve.x[i], 4) + "\n" + panel.y.label + ": " +
             plot::format_number(curve.y[i], 4);
    }
  if (!text.empty()) ImGui::SetTooltip("%s", text.c_str());
}

}  // namespace

void draw_study_pane(Ui& ui, PanelState& state, FigureCards& cards) {
  if (!state.shown) return;
  choose_kind(ui, state, state.study);
  if (state.study.kind == StudyKind::sweep)
    choose_sweep(ui, state, state.study);
  else
    choose_precision(ui, state, state.study);
  draw_start(ui, state);
  if (!state.studied) return;
  const StudyOutcome& outcome = *state.studied;
  ImGui::Separator();
  if (!outcome.message.empty()) wrapped(ui.theme.error, outcome.message);
  const bool same = outcome.study ? same_motion(outcome.motion, state.shown->motion)
                                  : outcome.document == simulated_part(state.history.now());
  if (!same) wrapped(ui.theme.warning, "of the scene as it was when this was started");
  if (!outcome.sentence.empty()) wrapped(ui.theme.text, outcome.sentence);
  ui.note("study sentence");
  for (FigureCard* card : cards.study(state.studied, state.trade, state.trade_news, figure_width(ui))) {
    const PlacedFigure place = draw_figure(ui, state, *card);
    ui.places["study figure"] = {place.origin.x, place.origin.y, place.x(card->layout.width),
                                 place.y(card->layout.height)};
    name_mark(ui, *card, place);
  }
}

}  // namespace unfurl
