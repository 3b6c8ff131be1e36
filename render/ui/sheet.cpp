// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/sheet.hpp"

#include <cmath>

#include "core/text/utf8.hpp"
#include "render/plot/lacking_letters.hpp"
#include "render/ui/font_file.hpp"
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
  for (const std::vector<ImWchar>& ranges : ranges_)
    add_glyphs(*ImGui::GetIO().Fonts, *font, pixels, bold, face, ranges.data());
  fonts_changed_ = true;
  ImGui::SetCurrentContext(outer_);
  return font;
}

void Sheet::need(std::string_view text) {
  std::vector<ImWchar> ranges;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t first = at;
    const char32_t c = next_code_point(text, at);
    if (c < 0x20 || is_common(c) || !needed_.insert(c).second) continue;
    if (c > 0xFFFF || !own_font_has(c)) plot::note_lacking(text.substr(first, at - first));
    if (c > 0xFFFF) continue;
    ranges.insert(ranges.end(), 2, static_cast<ImWchar>(c));
  }
  if (ranges.empty()) return;
  ranges.push_back(0);
  ranges_.push_back(std::move(ranges));
  outer_ = ImGui::GetCurrentContext();
  ImGui::SetCurrentContext(context_);
  for (const auto& [key, font] : fonts_) {
    const auto& [size, bold, face] = key;
    add_glyphs(*ImGui::GetIO().Fonts, *font, static_cast<float>(size) / 64, bold, *face,
               ranges_.back().data());
  }
  fonts_changed_ = true;
  ImGui::SetCurrentContext(outer_);
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
