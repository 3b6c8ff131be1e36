// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/panes/ui.hpp"

namespace unfurl {

void tooltip(const Ui& ui, const std::string& text) {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ui.px(340));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string kept = text;
  while (!kept.empty() && ImGui::CalcTextSize((kept + "\u2026").c_str()).x > width) {
    do kept.pop_back();
    while (!kept.empty() && (kept.back() & 0xC0) == 0x80);
  }
  while (!kept.empty() && kept.back() == ' ') kept.pop_back();
  return kept + "\u2026";
}

void wrapped(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

bool button(Ui& ui, const std::string& key, const std::string& label, const std::string& help, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button((label + "##" + key).c_str());
  ImGui::EndDisabled();
  ui.note(key);
  tooltip(ui, help);
  return pressed && enabled;
}

}  // namespace unfurl
