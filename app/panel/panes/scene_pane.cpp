// SPDX-License-Identifier: BSD-3-Clause
// The left pane: the scene and everything that can be changed of it.
#include <algorithm>
#include <filesystem>

#include "app/panel/document/scene_entries.hpp"
#include "app/panel/panes/panes.hpp"
#include "core/scene/library.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

// The problem of a key, or of an entry or member of it.
const SceneProblem* problem_of(const PanelState& state, const std::string& key) {
  for (const SceneProblem& problem : state.problems)
    if (problem.key == key || problem.key.starts_with(key + "[") || problem.key.starts_with(key + "."))
      return &problem;
  for (const SceneProblem& problem : state.picture_problems)
    if (problem.key == key) return &problem;
  return nullptr;
}

// The problem of just that key.
const SceneProblem* own_problem(const PanelState& state, const std::string& key) {
  for (const SceneProblem& problem : state.problems)
    if (problem.key == key) return &problem;
  return nullptr;
}

void reset_menu(Ui& ui, PanelState& state, const ParamRow& row) {
  if (!ImGui::BeginPopupContextItem(("menu of " + row.key).c_str())) return;
  const bool edited = state.history.now().edits.contains(row.key);
  if (ImGui::MenuItem(("Reset to the scene's " + value_caption(row.value, row.spec.unit)).c_str(), nullptr,
                      false, edited))
    state.history.forget(row.key);
  ui.note("reset " + row.key);
  if (!row.spec.required && !not_given(row.spec.fallback) &&
      ImGui::MenuItem(("Set to the default " + value_caption(row.spec.fallback, row.spec.unit)).c_str())) {
    state.history.edit(row.key, row.spec.fallback);
    state.history.end_gesture();
  }
  ui.note("default " + row.key);
  if (ImGui::MenuItem("Copy the key")) ImGui::SetClipboardText(row.key.c_str());
  ImGui::EndPopup();
}

const ParamValue& present_value(const PanelState& state, const ParamRow& row) {
  const auto& edits = state.history.now().edits;
  const auto it = edits.find(row.key);
  return it == edits.end() ? row.value : it->second;
}

}  // namespace

void draw_row(Ui& ui, PanelState& state, const ParamRow& row) {
  ParamValue value = present_value(state, row);
  std::string wrong = not_given(value) ? "" : range_error(row.spec, value);
  if (wrong.empty())
    if (const SceneProblem* problem = problem_of(state, row.key)) wrong = problem->message;
  const bool revealed = state.reveal == row.key;
  if (revealed) {
    ImGui::SetKeyboardFocusHere();
    state.reveal.clear();
  }
  const Variables variables(state.base.variables.begin(), state.base.variables.end());
  Typing typing{ui.typed, variables};
  const bool changed = draw_param(ui, row, value, !wrong.empty(), typing);
  if (typing.back)
    state.history.take_back(row.key);
  else if (changed)
    state.history.edit(row.key, value);
  const std::string about = row.label + ": ";
  if (!typing.problem.empty())
    state.message = about + typing.problem;
  else if (typing.typed && state.message.starts_with(about))
    state.message.clear();
  if (revealed) ImGui::SetScrollHereY();
  if (ImGui::IsItemDeactivated()) state.history.end_gesture();
  reset_menu(ui, state, row);
  if (!wrong.empty()) wrapped(ui.theme.error, wrong);
}

namespace {

// The table that a row's key belongs to: "solver." of "solver.step".
std::string_view table_of(const ParamRow& row) {
  return std::string_view(row.key).substr(0, row.key.rfind('.') + 1);
}

// Whether a parameter that the row goes with has a value that it goes with, and says anything itself.
bool in_force(const PanelState& state, const ParamSection& section, const ParamRow& row) {
  const std::string table(table_of(row));
  return row.spec.only.empty() || std::ranges::any_of(row.spec.only, [&](const ParamCondition& condition) {
           const auto other =
               std::ranges::find(section.rows, table + std::string(condition.other), &ParamRow::key);
           return other == section.rows.end() ||
                  (is_met(condition, present_value(state, *other)) && in_force(state, section, *other));
         });
}

// Whether the row says anything: its entry is on, and what it goes with is. Where something is wrong with it,
// always.
bool matters(const PanelState& state, const ParamSection& section, const ParamRow& row, bool entry_on) {
  if (problem_of(state, row.key)) return true;
  if (!row.entry.empty() && !entry_on) return false;
  return in_force(state, section, row);
}

// What an entry is, with a box to switch it off, and a button that takes it away where the panel added it.
// Returns whether its rows are to be seen: it is on, and not folded.
bool draw_entry(Ui& ui, PanelState& state, const ParamEntry& entry, const ParamRow& row) {
  ImGui::PushID(entry.key.c_str());
  ParamValue on = present_value(state, row);
  ImGui::Dummy({0, ui.px(1)});
  if (ImGui::Checkbox("##enabled", &std::get<bool>(on))) {
    state.history.edit(row.key, on);
    state.history.end_gesture();
  }
  ui.note(row.key);
  tooltip(ui, "switch it off and on\n" + row.key);
  ImGui::SameLine(0, ui.px(2));
  const bool folded = state.folded.contains(entry.key);
  if (ImGui::ArrowButton("##fold", folded ? ImGuiDir_Right : ImGuiDir_Down)) {
    if (folded)
      state.folded.erase(entry.key);
    else
      state.folded.insert(entry.key);
  }
  ui.note("fold " + entry.key);
  ImGui::SameLine(0, ui.px(4));
  const bool added = is_added(state.history.now(), entry.key);
  const float away = added ? ImGui::CalcTextSize("Remove").x + 2 * ImGui::GetStyle().FramePadding.x : 0.0f;
  ImGui::AlignTextToFramePadding();
  ImGui::PushFont(ui.bold);
  const float room = ImGui::GetContentRegionAvail().x - away - ui.px(8);
  ImGui::TextUnformatted(shortened(entry.title, room).c_str());
  ImGui::PopFont();
  tooltip(ui, entry.title + "\n" + entry.help + "\n" + entry.key);
  if (added) {
    ImGui::SameLine(ImGui::GetContentRegionMax().x - away);
    if (button(ui, "remove " + entry.key, "Remove", "take this entry away again"))
      state.intents.emplace_back([key = entry.key](LiveSession& s) {
        s.state().history.replace(without_entry(s.state().history.now(), key));
      });
  }
  ImGui::PopID();
  if (const SceneProblem* problem = own_problem(state, entry.key)) wrapped(ui.theme.error, problem->message);
  return std::get<bool>(on) && !state.folded.contains(entry.key);
}

void draw_section(Ui& ui, PanelState& state, const ParamSection& section) {
  bool on = true;
  for (const ParamRow& row : section.rows) {
    const bool first = !row.entry.empty() && row.spec.name == enabled_param().name;
    if (first) {
      for (const ParamEntry& entry : section.entries)
        if (entry.key == row.entry) on = draw_entry(ui, state, entry, row);
    } else if (matters(state, section, row, on)) {
      draw_row(ui, state, row);
    }
  }
}

// "Add..." with what there is, under the names that engineers know.
void draw_add(Ui& ui, PanelState& state, const std::string& table) {
  const std::string popup = "kinds of " + table, help = "to what is selected in the view";
  const auto add = [&](const ElementOffer& offer) {
    state.intents.emplace_back([offer](LiveSession& s) { s.add_entry(offer); });
  };
  if (table == "loads") {
    if (button(ui, "add loads", "Add a load", help)) add(element_offers(table).front());
    return;
  }
  const bool forces = table == "forces";
  if (button(ui, "add " + table, forces ? "Add a spring, a cable\u2026" : "Add a motor, a stop\u2026", help))
    ImGui::OpenPopup(popup.c_str());
  if (!ImGui::BeginPopup(popup.c_str())) return;
  for (const ElementOffer& offer : element_offers(table)) {
    if (ImGui::Selectable(offer.name.c_str())) add(offer);
    ui.note("add " + std::string(offer.kind) + (offer.extra.empty() ? "" : " " + offer.name));
    ImGui::SameLine(ui.px(130));
    ImGui::TextColored(ui.theme.dim, "%s", offer.sentence.c_str());
  }
  ImGui::EndPopup();
}

// Problems that no row shows.
void draw_other_problems(const Ui& ui, const PanelState& state) {
  for (const SceneProblem& problem : state.problems) {
    bool shown = false;
    for (const auto& section : state.sections) {
      for (const auto& row : section.rows) shown = shown || problem_of(state, row.key) == &problem;
      for (const auto& entry : section.entries) shown = shown || entry.key == problem.key;
    }
    if (!shown) wrapped(ui.theme.error, problem.key + ": " + problem.message);
  }
}

void draw_scene_choice(Ui& ui, PanelState& state) {
  const SceneDocument& now = state.history.now();
  const std::string name = std::filesystem::path(now.name).stem().string();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##scene", (name + (is_edited(now) ? " *" : "")).c_str(),
                        ImGuiComboFlags_HeightLarge)) {
    for (const LibraryScene& scene : library_scenes()) {
      const bool is = scene.path == now.path;
      if (ImGui::Selectable((scene.name + "   " + scene.title).c_str(), is) && !is)
        state.intents.emplace_back([path = scene.path](LiveSession& s) { s.open(open_document(path, {})); });
      ui.note("scene=" + scene.name);
    }
    ImGui::EndCombo();
  }
  ui.note("scene");
  tooltip(ui, "scene: those that come with the program");
  const std::string kind = state.shown ? state.shown->scene.kind : "";
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(ui.theme.dim, "family");
  ImGui::SameLine(ImGui::GetCursorStartPos().x + 0.44f * ImGui::GetContentRegionAvail().x);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##family", kind.c_str())) {
    for (const Family& family : families()) {
      if (ImGui::Selectable(std::string(family.kind).c_str(), kind == family.kind) && kind != family.kind)
        state.intents.emplace_back(
            [name = std::string(family.kind)](LiveSession& s) { s.open(document_of_family(name)); });
      tooltip(ui, std::string(family.help));
      ui.note("family=" + std::string(family.kind));
    }
    ImGui::EndCombo();
  }
  ui.note("family");
  if (const Family* family = find_family(kind)) tooltip(ui, std::string(family->help));
}

}  // namespace

// Opens a section in which a parameter is looked for.
void reveal_in(PanelState& state, const ParamSection& section) {
  for (const ParamRow& row : section.rows)
    if (row.key == state.reveal) {
      ImGui::SetNextItemOpen(true);
      state.folded.erase(row.entry);
    }
}

void draw_scene_pane(Ui& ui, PanelState& state) {
  draw_scene_choice(ui, state);
  draw_row(ui, state, state.title_row);
  draw_other_problems(ui, state);
  for (const ParamSection& section : state.sections) {
    if (!state.reveal.empty()) reveal_in(state, section);
    ImGui::PushFont(ui.bold);
    const bool open = ImGui::CollapsingHeader(
        section.title.c_str(), section.open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
    ImGui::PopFont();
    ui.note("section " + section.title);
    if (!open) continue;
    draw_section(ui, state, section);
    if (!section.grows.empty()) draw_add(ui, state, section.grows);
  }
  if (state.shown)
    for (const std::string& warning : state.shown->warnings) wrapped(ui.theme.warning, warning);
}

}  // namespace unfurl
