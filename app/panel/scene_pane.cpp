// The left pane: the scene and everything that can be changed of it.
#include <algorithm>
#include <filesystem>

#include "app/panel/panes.hpp"
#include "core/scene/library.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

void wrapped(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

// The problem of a key, or of an entry or member of it.
const SceneProblem* problem_of(const PanelState& state, const std::string& key) {
  for (const SceneProblem& problem : state.problems)
    if (problem.key == key || problem.key.starts_with(key + "[") || problem.key.starts_with(key + "."))
      return &problem;
  for (const SceneProblem& problem : state.picture_problems)
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
  if (!row.spec.required &&
      ImGui::MenuItem(("Set to the default " + value_caption(row.spec.fallback, row.spec.unit)).c_str())) {
    state.history.edit(row.key, row.spec.fallback);
    state.history.end_gesture();
  }
  ui.note("default " + row.key);
  if (ImGui::MenuItem("Copy the key")) ImGui::SetClipboardText(row.key.c_str());
  ImGui::EndPopup();
}

}  // namespace

void draw_row(Ui& ui, PanelState& state, const ParamRow& row) {
  const auto& edits = state.history.now().edits;
  const auto it = edits.find(row.key);
  ParamValue value = it == edits.end() ? row.value : it->second;
  std::string wrong = range_error(row.spec, value);
  if (wrong.empty())
    if (const SceneProblem* problem = problem_of(state, row.key)) wrong = problem->message;
  if (draw_param(ui, row, value, !wrong.empty())) state.history.edit(row.key, value);
  if (ImGui::IsItemDeactivated()) state.history.end_gesture();
  reset_menu(ui, state, row);
  if (!wrong.empty()) wrapped(ui.theme.error, wrong);
}

namespace {

// Problems that no row shows.
void draw_other_problems(const Ui& ui, const PanelState& state) {
  for (const SceneProblem& problem : state.problems) {
    bool shown = false;
    for (const auto& section : state.sections)
      for (const auto& row : section.rows) shown = shown || problem_of(state, row.key) == &problem;
    if (!shown) wrapped(ui.theme.error, problem.key + ": " + problem.message);
  }
}

void open_scene(PanelState& state, const SceneDocument& document) {
  state.history.replace(document);
  state.orbit.reset();
}

void draw_scene_choice(Ui& ui, PanelState& state) {
  const SceneDocument& now = state.history.now();
  const std::string name = std::filesystem::path(now.name).stem().string();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##scene", (name + (now.edits.empty() ? "" : " *")).c_str(),
                        ImGuiComboFlags_HeightLarge)) {
    for (const LibraryScene& scene : library_scenes()) {
      const bool is = scene.path == now.path;
      if (ImGui::Selectable((scene.name + "   " + scene.title).c_str(), is) && !is)
        open_scene(state, open_document(scene.path, {}));
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
        open_scene(state, document_of_family(std::string(family.kind)));
      tooltip(ui, std::string(family.help));
      ui.note("family=" + std::string(family.kind));
    }
    ImGui::EndCombo();
  }
  ui.note("family");
  if (const Family* family = find_family(kind)) tooltip(ui, std::string(family->help));
}

}  // namespace

void draw_scene_pane(Ui& ui, PanelState& state) {
  draw_scene_choice(ui, state);
  draw_other_problems(ui, state);
  // Copied: opening another scene while they are drawn replaces the sections.
  const auto sections = state.sections;
  for (const ParamSection& section : sections) {
    ImGui::PushFont(ui.bold);
    const bool open = ImGui::CollapsingHeader(
        section.title.c_str(), section.open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
    ImGui::PopFont();
    ui.note("section " + section.title);
    if (!open) continue;
    for (const ParamRow& row : section.rows) draw_row(ui, state, row);
  }
  if (state.shown)
    for (const std::string& warning : state.shown->warnings) wrapped(ui.theme.warning, warning);
}

}  // namespace unfurl
