// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/sheet.hpp"

#include <cmath>

#include "render/ui/fonts.hpp"

namespace unfurl {

Sheet::Sheet() {
  outer_ = ImGui::GetCurrentContext();
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no settings file
  io.LogFilename = nullptr;
  io.DeltaTime = 1.0f / 60.0f;
  ImguiPainter::announce(io);
  ImGui::SetCurrentContext(outer_);
}

Sheet::~Sheet() {
  ImGui::DestroyContext(context_);
}

ImFont* Sheet::font(float pixels, bool bold) {
  return font_of(pixels, bold, plot::typefaces().front());
}

ImFont* Sheet::plot_font(float pixels) {
  return font_of(pixels, false, plot::typeface());
}

ImFont* Sheet::font_of(float pixels, bool bold, const plot::Typeface& face) {
  ImFont*& font = fonts_[{static_cast<int>(std::lround(pixels * 64.0f)), bold, &face}];
  if (font != nullptr) return font;
  outer_ = ImGui::GetCurrentContext();
  ImGui::SetCurrentContext(context_);
  const bool own = &face == &plot::typefaces().front();
  font = own ? add_font(*ImGui::GetIO().Fonts, pixels, bold) : add_plot_font(*ImGui::GetIO().Fonts, pixels);
  fonts_changed_ = true;
  ImGui::SetCurrentContext(outer_);
  return font;
}

ImDrawList& Sheet::begin(int width, int height) {
  if (fonts_.empty()) font(16.0f);
  outer_ = ImGui::GetCurrentContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  if (fonts_changed_) {
    io.Fonts->Build();
    painter_.upload_fonts(*io.Fonts);
    fonts_changed_ = false;
  }
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  ImGui::NewFrame();
  return *ImGui::GetBackgroundDrawList();
}

void Sheet::end() {
  ImGui::Render();
  painter_.draw(*ImGui::GetDrawData());
  ImGui::SetCurrentContext(outer_);
}

}  // namespace unfurl
