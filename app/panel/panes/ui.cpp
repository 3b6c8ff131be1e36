// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/panes/ui.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace unfurl {

Pane::Pane(const char* name, float x, float y, float width, float height, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos({x, y});
  ImGui::SetNextWindowSize({std::max(1.0f, width), std::max(1.0f, height)});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
}

Pane::~Pane() {
  if (std::uncaught_exceptions() == before_) ImGui::End();
}

Box::Box(Ui& ui, const char* name, float width, bool top) : ui_(ui), name_(name) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float room = screen.x - ui.px(24);
  ImGui::SetNextWindowPos({0.5f * screen.x, top ? ui.px(52) : 0.5f * screen.y}, ImGuiCond_Always,
                          {0.5f, top ? 0.0f : 0.5f});
  if (width > 0) ImGui::SetNextWindowSize({std::min(ui.px(width), room), 0});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {room, screen.y - ui.px(60)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(6));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   (width > 0 ? 0 : ImGuiWindowFlags_AlwaysAutoResize));
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
}

Box::~Box() {
  if (std::uncaught_exceptions() != before_) return;
  const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ui_.places[name_ + " box"] = {low.x, low.y, low.x + size.x, low.y + size.y};
  const float end = ImGui::GetCursorPosY();
  if (std::exchange(ui_.box_ends[name_], end) != end) ui_.unsettled = true;
}

void Box::heading(const char* text) const {
  ImGui::Dummy({0, ui_.px(2)});
  ImGui::PushFont(ui_.bold);
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

std::vector<char> typing_room(const std::string& text) {
  std::vector<char> buffer(2 * text.size() + 4096);
  std::copy(text.begin(), text.end(), buffer.begin());
  return buffer;
}

bool text_field(Ui& ui, const std::string& key, std::string& value, float width, const char* hint,
                ImGuiInputTextFlags flags, ImGuiInputTextCallback callback) {
  std::vector<char> buffer = typing_room(value);
  ImGui::SetNextItemWidth(width);
  const bool entered =
      ImGui::InputTextWithHint(("##" + key).c_str(), hint, buffer.data(), buffer.size(), flags, callback);
  ui.note(key);
  const bool changed = value != buffer.data();
  if (changed) value = buffer.data();
  return (flags & ImGuiInputTextFlags_EnterReturnsTrue) != 0 ? entered : changed;
}

// Below the widget, or above it where there is no room: it covers none of its neighbours in a row. As far to
// the left as it takes to be whole.
void tooltip(const Ui& ui, const std::string& text) {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImVec2 takes = ImGui::CalcTextSize(text.c_str(), nullptr, false, ui.px(340)),
               screen = ImGui::GetIO().DisplaySize;
  const bool above = high.y + takes.y + ui.px(30) > screen.y;
  const float left = std::max(0.0f, std::min(low.x, screen.x - takes.x - ui.px(30)));
  ImGui::SetNextWindowPos({left, above ? low.y - ui.px(6) : high.y + ui.px(6)}, ImGuiCond_Always,
                          {0, above ? 1.0f : 0.0f});
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
    bool within = true;  // a letter of several bytes
    while (within && !kept.empty()) {
      within = (kept.back() & 0xC0) == 0x80;
      kept.pop_back();
    }
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

plot::Rect text_on_ground(const Ui& ui, const ImVec2& at, const char* text, float opaque, float room) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, room);
  const ImVec2 low(at.x - ui.px(5), at.y - ui.px(2));
  const ImVec2 high(at.x + size.x + ui.px(5), at.y + size.y + ui.px(2));
  list.AddRectFilled(low, high, ui.color(ui.theme.window, opaque), ui.px(4));
  list.AddText(nullptr, 0, at, ui.color(ui.theme.text), text, nullptr, room);
  return {low.x, low.y, high.x, high.y};
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
