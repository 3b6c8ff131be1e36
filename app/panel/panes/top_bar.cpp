// SPDX-License-Identifier: BSD-3-Clause
// The bar along the top, and the list of keys.
#include <cstddef>
#include <string>
#include <vector>

#include "app/panel/actions.hpp"
#include "app/panel/panes/panes.hpp"

namespace unfurl {

namespace {

void left_buttons(Ui& ui, PanelState& state) {
  if (button(ui, "open", "Open\u2026", "a file, a new scene (Ctrl O)")) state.files_open = true;
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "export", "Export\u2026", "scene, film, figures, files for other programs (E)"))
    state.export_open = true;
  ImGui::SameLine(0, ui.px(12));
  if (button(ui, "undo", "Undo", "undo (Ctrl Z)", state.history.can_undo())) state.history.undo();
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "redo", "Redo", "redo (Ctrl Y)", state.history.can_redo())) state.history.redo();
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "reset all", "Reset", "reset every change of the scene (R); can be undone",
             is_edited(state.history.now())))
    state.history.replace(without_edits(state.history.now()));
  ImGui::SameLine(0, ui.px(12));
  const bool pinned = state.pinned != nullptr;
  if (button(ui, "pin", pinned ? "Unpin A" : "Pin as A",
             "keep this run as A, change something and compare (P)", state.shown != nullptr))
    state.pinned = pinned ? nullptr : state.shown;
}

// In a line or, where that is too short, in two.
void draw_message(Ui& ui, const std::string& text, float room) {
  ImGui::BeginGroup();
  if (ImGui::CalcTextSize(text.c_str()).x <= room) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(ui.theme.dim, "%s", text.c_str());
  } else {
    const float row = ImGui::GetFrameHeight();
    std::size_t end = 0;  // of the words that the first line holds
    for (std::size_t at = text.find(' '); at != text.npos; at = text.find(' ', at + 1)) {
      if (ImGui::CalcTextSize(text.substr(0, at).c_str()).x > room) break;
      end = at;
    }
    const float left = ImGui::GetCursorPosX();
    const float high = ImGui::GetTextLineHeight();
    float top = ImGui::GetCursorPosY() + row / 2 - high;
    for (const std::string& line : {text.substr(0, end), text.substr(end == 0 ? 0 : end + 1)}) {
      ImGui::SetCursorPos({left, top});
      ImGui::TextColored(ui.theme.dim, "%s", shortened(line, room).c_str());
      top += high;
    }
  }
  ImGui::EndGroup();
  ui.note("message");
  tooltip(ui, text);
}

}  // namespace

void draw_top_bar(Ui& ui, PanelState& state) {
  left_buttons(ui, state);
  ImGui::SameLine(0, ui.px(12));
  const ImGuiStyle& style = ImGui::GetStyle();
  const bool narrow = ImGui::GetWindowWidth() < ui.px(760);
  const char* find = narrow ? "\u2026" : "Find\u2026";
  float words = 0;
  for (const char* word : {find, state.dark ? "Light" : "Dark", "Keys"})
    words += ImGui::CalcTextSize(word).x + 2 * style.FramePadding.x + ui.px(4);
  const float right = ImGui::GetWindowWidth() - style.WindowPadding.x - words + ui.px(4);
  const float room = right - ImGui::GetCursorPosX() - ui.px(8);
  if (!state.message.empty() && room > ui.px(40)) draw_message(ui, state.message, room);
  ImGui::SameLine(right);
  if (button(ui, "palette", find, "any action or parameter by its name (Ctrl P)")) state.palette_open = true;
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "theme", state.dark ? "Light" : "Dark", "light or dark (T)")) state.dark = !state.dark;
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "help", "Keys", "what the keys do (F1 or ?)")) state.help_open = !state.help_open;
}

void draw_help(Ui& ui, PanelState& state) {
  if (!state.help_open) return;
  const Box box(ui, "help", 0);
  box.heading("Keys");
  const auto row = [&](const std::string& name, const std::string& help) {
    const float left = ImGui::GetCursorPosX();
    ImGui::TextColored(ui.theme.accent, "%s", name.c_str());
    ImGui::SameLine(left + ui.px(92));
    ImGui::TextUnformatted(help.c_str());
  };
  std::vector<const Action*> rows;
  for (const Action& action : actions())
    if (!action.keys.empty()) rows.push_back(&action);
  const bool narrow = ImGui::GetIO().DisplaySize.x < ui.px(860);
  const std::size_t half = narrow ? rows.size() : (rows.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) {
    row(std::string(rows[i]->keys), std::string(rows[i]->help));
    if (i + half >= rows.size()) continue;
    ImGui::SameLine(ui.px(440));
    row(std::string(rows[i + half]->keys), std::string(rows[i + half]->help));
  }
  ImGui::Separator();
  row("Tab, arrows", "from widget to widget; Enter or typing changes, Esc leaves; F6 the next pane");
  row("drag", "turn the view; with Shift or the right button: move it");
  row("wheel", "nearer or farther, towards the pointer");
  row("click", "read a rod or a node");
  row("Ctrl click", "type a slider's value");
  row("right click", "reset a parameter");
}

}  // namespace unfurl
