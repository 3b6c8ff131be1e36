// SPDX-License-Identifier: BSD-3-Clause
// The export box: the scene as a file, what else is made of it and where, the command line that does the
// same.
#include <filesystem>

#include "app/panel/document/file_list.hpp"
#include "app/panel/panes/panes.hpp"

namespace unfurl {

namespace {

void save_as(Ui& ui, PanelState& state, const Box& box) {
  box.heading("Scene");
  text_field(ui, "scene path", state.export_path, box.width() - ui.px(90));
  ImGui::SameLine();
  const bool same = state.export_path == state.history.now().path;
  const bool sound = state.problems.empty() && !state.export_path.empty();
  if (button(ui, "save", same ? "Save" : "Save as",
             "the changed values in their places; comments and order of the file stay", sound))
    state.intents.emplace_back([path = state.export_path](LiveSession& s) { s.save(path); });
  if (same && of_library(state.export_path))
    ImGui::TextColored(ui.theme.warning, "this is the program's own copy of the scene");
}

// What, where to, and what is there.
void export_files(Ui& ui, PanelState& state, const Box& box) {
  box.heading("Export");
  const auto kinds = export_kinds();
  const ExportKind& kind = kinds[state.export_kind];
  ImGui::SetNextItemWidth(ui.px(160));
  if (ImGui::BeginCombo("##export kind", std::string(kind.name).c_str(), ImGuiComboFlags_HeightLarge)) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      const std::string name(kinds[i].name);
      if (ImGui::Selectable(name.c_str(), i == state.export_kind)) state.export_kind = i;
      ui.note("export kind=" + name);
      ImGui::SameLine(ui.px(150));
      ImGui::TextColored(ui.theme.dim, "%s", std::string(kinds[i].help).c_str());
    }
    ImGui::EndCombo();
  }
  ui.note("export kind");
  ImGui::SameLine();
  text_field(ui, "output", state.export_output, box.width() - ui.px(250));
  ImGui::SameLine();
  const bool ready = !state.exporting.running && state.problems.empty() && !state.export_output.empty();
  if (button(ui, "start export", "Export", "beside this window, by the command line below", ready))
    state.intents.emplace_back([](LiveSession& s) { s.start_export(); });
  std::error_code unknown;  // a name that is too long, a folder that may not be looked into
  const std::filesystem::path whole = std::filesystem::absolute(at_home(state.export_output), unknown);
  if (!unknown) wrapped(ui.theme.dim, std::string(kind.help) + ", into " + whole.lexically_normal().string());
}

}  // namespace

void draw_export(Ui& ui, PanelState& state) {
  if (!state.export_open) return;
  const SceneDocument& now = state.history.now();
  if (state.export_path.empty()) state.export_path = proposed_file(now);
  const Box box(ui, "export", 600);
  save_as(ui, state, box);
  export_files(ui, state, box);
  box.heading("Command line");
  const std::string output = at_home(state.export_output);
  const bool in_file = !now.path.empty() && state.own_file == OwnFile::same;
  const std::string line = export_command(now, export_kinds()[state.export_kind], output, in_file);
  wrapped(ui.theme.text, line);
  if (!in_file)
    wrapped(ui.theme.dim, "Export writes the scene that is shown to " + exported_scene(now, output, in_file) +
                              " first: no file holds it");
  if (button(ui, "copy", "Copy", "to the clipboard")) ImGui::SetClipboardText(line.c_str());
  ImGui::SameLine();
  if (button(ui, "open folder", "Open folder", "of what was exported last", !state.exported.empty()))
    state.intents.emplace_back(&LiveSession::open_folder);
  ImGui::SameLine();
  if (button(ui, "close export", "Close", "Esc")) state.export_open = false;
  if (state.exporting.running) {
    ImGui::SameLine();
    if (button(ui, "stop export", "Stop the export",
               "what is simulated is kept; of figures alone those that are written"))
      state.intents.emplace_back(&LiveSession::stop_export);
  }
  if (state.message.empty()) return;
  wrapped(ui.theme.dim, state.message);
  ui.note("export said");
}

}  // namespace unfurl
