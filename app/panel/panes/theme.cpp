// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/panes/theme.hpp"

namespace unfurl {

namespace {

ImVec4 rgb(unsigned hex, float alpha = 1.0f) {
  const auto part = [&](unsigned shift) { return static_cast<float>(hex >> shift & 255U) / 255.0f; };
  return {part(16), part(8), part(0), alpha};
}

Theme colors(bool dark) {
  Theme t;
  t.dark = dark;
  t.window = dark ? rgb(0x1c2127) : rgb(0xf5f6f8);
  t.text = dark ? rgb(0xe4e8ec) : rgb(0x1f262d);
  t.dim = dark ? rgb(0x95a1ad) : rgb(0x616d79);
  t.accent = dark ? rgb(0x4aa3df) : rgb(0x0a6cb0);
  t.warning = dark ? rgb(0xe8b04a) : rgb(0x8a5a00);
  t.error = dark ? rgb(0xff8a7a) : rgb(0xb3261e);
  t.rule = dark ? rgb(0x39424c) : rgb(0xd3d9df);
  t.curve_a = dark ? rgb(0xb9a0e0) : rgb(0x7a4ea3);
  t.curve_b = t.accent;
  return t;
}

void set_sizes(ImGuiStyle& style, float scale) {
  style = ImGuiStyle();
  style.WindowPadding = {12, 10};
  style.FramePadding = {7, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.ScrollbarSize = 11;
  style.GrabMinSize = 9;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.PopupRounding = 6;
  style.ScrollbarRounding = 6;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 1;
  style.PopupBorderSize = 1;
  style.ScaleAllSizes(scale);
}

void set_colors(ImGuiStyle& style, const Theme& t) {
  t.dark ? ImGui::StyleColorsDark(&style) : ImGui::StyleColorsLight(&style);
  const auto with = [](ImVec4 c, float alpha) { return ImVec4(c.x, c.y, c.z, alpha); };
  ImVec4* c = style.Colors;
  const ImVec4 field = t.dark ? rgb(0x2a313a) : rgb(0xffffff);
  c[ImGuiCol_Text] = t.text;
  c[ImGuiCol_TextDisabled] = t.dim;
  c[ImGuiCol_WindowBg] = c[ImGuiCol_ChildBg] = t.window;
  c[ImGuiCol_PopupBg] = t.dark ? rgb(0x252c34) : rgb(0xffffff);
  c[ImGuiCol_Border] = t.rule;
  c[ImGuiCol_FrameBg] = field;
  c[ImGuiCol_FrameBgHovered] = t.dark ? rgb(0x333c47) : rgb(0xeaf2f9);
  c[ImGuiCol_FrameBgActive] = t.dark ? rgb(0x3a4551) : rgb(0xdcebf7);
  c[ImGuiCol_CheckMark] = t.accent;
  c[ImGuiCol_SliderGrab] = with(t.accent, 0.38f);  // the value stays readable on it
  c[ImGuiCol_SliderGrabActive] = with(t.accent, 0.60f);
  c[ImGuiCol_Button] = t.dark ? rgb(0x313a44) : rgb(0xffffff);
  c[ImGuiCol_ButtonHovered] = t.dark ? rgb(0x3d4854) : rgb(0xe3eef8);
  c[ImGuiCol_ButtonActive] = with(t.accent, 0.45f);
  c[ImGuiCol_Header] = t.dark ? rgb(0x2a313a) : rgb(0xe6eaee);
  c[ImGuiCol_HeaderHovered] = t.dark ? rgb(0x35404b) : rgb(0xdbe6f0);
  c[ImGuiCol_HeaderActive] = with(t.accent, 0.35f);
  c[ImGuiCol_Separator] = t.rule;
  c[ImGuiCol_TextSelectedBg] = with(t.accent, 0.35f);
  c[ImGuiCol_ScrollbarBg] = with(t.window, 0.0f);
  c[ImGuiCol_ScrollbarGrab] = t.rule;
  c[ImGuiCol_ModalWindowDimBg] = rgb(0x000000, 0.35f);
}

}  // namespace

Theme apply_theme(bool dark, float scale) {
  const Theme theme = colors(dark);
  ImGuiStyle& style = ImGui::GetStyle();
  set_sizes(style, scale);
  set_colors(style, theme);
  return theme;
}

}  // namespace unfurl
