// SPDX-License-Identifier: BSD-3-Clause
// Opening a scene: a file by its path, a recent one, one that comes with the program, or a new one. And what
// is asked before something is lost.
#include <cstring>
#include <filesystem>

#include "app/panel/document/file_list.hpp"
#include "app/panel/panes/panes.hpp"
#include "core/scene/library.hpp"
#include "core/structures/family.hpp"

namespace unfurl {

namespace {

void open_path(PanelState& state, const std::string& path) {
  state.intents.emplace_back([path](LiveSession& s) { s.open_file(path); });
}

// Tab completes what is typed.
int complete(ImGuiInputTextCallbackData* data) {
  const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
  const std::string whole = completed_path(typed);
  if (whole != typed) {
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, whole.c_str());
  }
  return 0;
}

void draw_path(Ui& ui, PanelState& state, const Box& box) {
  box.heading("Open a scene");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered =
      text_field(ui, "file path", state.file_path, box.width() - ui.px(80), "a path; Tab completes",
                 ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_EnterReturnsTrue, complete);
  ImGui::SameLine();
  if (button(ui, "open file", "Open", "Enter", !state.file_path.empty()) ||
      (entered && !state.file_path.empty()))
    open_path(state, state.file_path);
}

void draw_folder(Ui& ui, PanelState& state, float width) {
  ImGui::BeginChild("folder", {width, ui.px(210)}, true);
  for (const FileEntry& entry : matching_files(state.file_path)) {
    if (ImGui::Selectable(entry.name.c_str())) {
      state.file_path = entry.path;
      if (!entry.name.ends_with("/")) open_path(state, entry.path);
    }
    ui.note("file=" + entry.name);
  }
  ImGui::EndChild();
}

void draw_known(Ui& ui, PanelState& state) {
  ImGui::BeginChild("known", {0, ui.px(210)}, true);
  if (!state.recent.empty()) ImGui::TextColored(ui.theme.dim, "Recent");
  for (const std::string& path : state.recent) {
    const std::filesystem::path file(path);
    if (ImGui::Selectable((file.filename().string() + "##" + path).c_str())) open_path(state, path);
    ui.note("recent=" + path);
    tooltip(ui, path);
  }
  ImGui::TextColored(ui.theme.dim, "Come with the program");
  for (const LibraryScene& scene : library_scenes()) {
    if (ImGui::Selectable((scene.name + "##library").c_str())) open_path(state, scene.path);
    ui.note("library=" + scene.name);
    tooltip(ui, scene.title);
  }
  ImGui::EndChild();
}

void draw_new(Ui& ui, PanelState& state, const Box& box) {
  box.heading("New");
  if (button(ui, "new from nothing", "From nothing", "two nodes and a rod, to build on by hand"))
    state.intents.emplace_back(&LiveSession::build_from_nothing);
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  for (const Family& family : families()) {
    const std::string kind(family.kind);
    const float wide = ImGui::CalcTextSize(kind.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
    if (ImGui::GetItemRectMax().x + ui.px(6) + wide < right) ImGui::SameLine(0, ui.px(6));
    if (button(ui, "new " + kind, kind, std::string(family.help)))
      state.intents.emplace_back([kind](LiveSession& s) { s.open(document_of_family(kind)); });
  }
}

}  // namespace

void draw_files(Ui& ui, PanelState& state) {
  if (!state.files_open) return;
  const Box box(ui, "files", 640);
  draw_path(ui, state, box);
  draw_folder(ui, state, 0.55f * box.width());
  ImGui::SameLine();
  draw_known(ui, state);
  draw_new(ui, state, box);
  ImGui::Dummy({0, ui.px(2)});
  if (button(ui, "close files", "Close", "Esc")) state.files_open = false;
  if (!state.message.empty()) wrapped(ui.theme.dim, state.message);
}

void draw_question(Ui& ui, PanelState& state) {
  if (state.question.text.empty()) return;
  const Box box(ui, "question", 440);
  wrapped(ui.theme.text, state.question.text);
  ImGui::Dummy({0, ui.px(4)});
  const Question asked = state.question;  // an answer may ask another
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  for (const auto& [answer, intent] : asked.answers) {
    if (button(ui, "answer " + answer, answer, "")) {
      state.question = {};
      if (intent) state.intents.push_back(intent);
    }
    ImGui::SameLine();
  }
  ImGui::NewLine();
}

}  // namespace unfurl
