// SPDX-License-Identifier: BSD-3-Clause
// The bar along the top, and the list of keys.
#include <cstdio>

#include "app/panel/actions.hpp"
#include "app/panel/panes/panes.hpp"

namespace unfurl {

void draw_top_bar(Ui& ui, PanelState& state) {
  if (button(ui, "undo", "Undo", "undo (Ctrl Z)", state.history.can_undo())) state.history.undo();
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "redo", "Redo", "redo (Ctrl Y)", state.history.can_redo())) state.history.redo();
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "reset all", "Reset", "reset every change of the scene (R)", is_edited(state.history.now())))
    state.history.replace(without_edits(state.history.now()));
  ImGui::SameLine(0, ui.px(16));
  const bool pinned = state.pinned != nullptr;
  if (button(ui, "pin", pinned ? "Unpin A" : "Pin as A",
             "keep this run as A, change something and compare (P)", state.shown != nullptr))
    state.pinned = pinned ? nullptr : state.shown;
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "export", "Export\u2026", "scene, film, figures, command line (E)"))
    state.export_open = true;
  ImGui::SameLine(0, ui.px(16));
  ImGui::AlignTextToFramePadding();
  if (!state.message.empty()) ImGui::TextColored(ui.theme.dim, "%s", state.message.c_str());
  const float words = ImGui::CalcTextSize(state.dark ? "Light" : "Dark").x + ImGui::CalcTextSize("Keys").x;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float right =
      ImGui::GetWindowWidth() - style.WindowPadding.x - words - 4 * style.FramePadding.x - ui.px(4);
  ImGui::SameLine(right);
  if (button(ui, "theme", state.dark ? "Light" : "Dark", "light or dark (T)")) state.dark = !state.dark;
  ImGui::SameLine(0, ui.px(4));
  if (button(ui, "help", "Keys", "what the keys do (F1 or ?)")) state.help_open = !state.help_open;
}

void draw_help(Ui& ui, PanelState& state) {
  if (!state.help_open) return;
  const ImVec2 middle(0.5f * ImGui::GetIO().DisplaySize.x, 0.5f * ImGui::GetIO().DisplaySize.y);
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  ImGui::Begin("help", &state.help_open,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushFont(ui.bold);
  ImGui::TextUnformatted("Keys");
  ImGui::PopFont();
  const auto row = [&](const std::string& name, const std::string& help) {
    ImGui::TextColored(ui.theme.accent, "%s", name.c_str());
    ImGui::SameLine(ui.px(150));
    ImGui::TextUnformatted(help.c_str());
  };
  for (const Action& action : actions())
    if (!action.keys.empty()) row(std::string(action.keys), std::string(action.help));
  ImGui::Separator();
  row("drag", "turn the view; with Shift or the right button: move it");
  row("wheel", "nearer or farther, towards the pointer");
  row("click", "read a rod or a node");
  row("Ctrl click", "type a slider's value");
  row("right click", "reset a parameter");
  ui.places["help box"] = {ImGui::GetWindowPos().x, ImGui::GetWindowPos().y,
                           ImGui::GetWindowPos().x + ImGui::GetWindowSize().x,
                           ImGui::GetWindowPos().y + ImGui::GetWindowSize().y};
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
}

}  // namespace unfurl
