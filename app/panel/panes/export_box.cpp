// SPDX-License-Identifier: BSD-3-Clause
// The export box: the scene as a file, the film and the figures, the command line that makes them.
#include <cstdio>
#include <filesystem>

#include "app/panel/panes/panes.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/library.hpp"

namespace unfurl {

namespace {

void text_field(Ui& ui, const std::string& key, std::string& value, float width) {
  char buffer[1024];
  std::snprintf(buffer, sizeof buffer, "%s", value.c_str());
  ImGui::SetNextItemWidth(width);
  if (ImGui::InputText(("##" + key).c_str(), buffer, sizeof buffer)) value = buffer;
  ui.note(key);
}

void heading(const Ui& ui, const char* text) {
  ImGui::Dummy({0, ui.px(2)});
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

bool of_library(const std::string& path) {
  for (const LibraryScene& scene : library_scenes())
    if (scene.path == path) return true;
  return false;
}

void save_as(Ui& ui, PanelState& state, float width) {
  heading(ui, "Scene");
  text_field(ui, "scene path", state.export_path, width - ui.px(90));
  ImGui::SameLine();
  std::error_code unknown;  // a name that is too long, a folder that may not be looked into
  const bool exists = std::filesystem::exists(state.export_path, unknown);
  const bool same = state.export_path == state.history.now().path;
  const bool sound = state.problems.empty() && !state.export_path.empty();
  if (button(ui, "save", same ? "Save" : "Save as",
             "the changed values in their places; comments and order of the file stay", sound))
    state.intents.emplace_back([path = state.export_path](LiveSession& s) { s.save(path); });
  if (exists && !same) ImGui::TextColored(ui.theme.warning, "this file exists and would be replaced");
  if (same && of_library(state.export_path))
    ImGui::TextColored(ui.theme.warning, "this is the program's own copy of the scene");
}

void render(Ui& ui, PanelState& state, float width) {
  heading(ui, "Film and figures");
  text_field(ui, "output", state.export_output, width - ui.px(190));
  const bool ready = !state.exporting.running && state.problems.empty() && !state.export_output.empty();
  const std::pair<const char*, const char*> verbs[] = {{"render", "All"}, {"figure", "Figures"}};
  for (const auto& [verb, label] : verbs) {
    ImGui::SameLine();
    if (button(ui, std::string("export ") + verb, label, "by the command line below, beside this window",
               ready))
      state.intents.emplace_back([verb](LiveSession& s) { s.start_export(verb); });
  }
}

}  // namespace

void draw_export(Ui& ui, PanelState& state) {
  if (!state.export_open) return;
  if (state.export_path.empty()) {
    const std::string& path = state.history.now().path;
    state.export_path = path.empty() || of_library(path)
                            ? std::filesystem::path(state.history.now().name).stem().string() + ".toml"
                            : path;
  }
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float width = std::min(ui.px(560), screen.x - ui.px(40));
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  ImGui::Begin("export", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  const float inside = ImGui::GetContentRegionAvail().x;
  save_as(ui, state, inside);
  render(ui, state, inside);
  heading(ui, "Command line");
  const std::string line = command_line(state.history.now(), "render", state.export_output);
  wrapped(ui.theme.text, line);
  if (button(ui, "copy", "Copy", "to the clipboard")) ImGui::SetClipboardText(line.c_str());
  ImGui::SameLine();
  if (button(ui, "close export", "Close", "Esc")) state.export_open = false;
  if (!state.message.empty()) wrapped(ui.theme.dim, state.message);
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

}  // namespace unfurl
