// SPDX-License-Identifier: BSD-3-Clause
// A sheet to draw on with ImGui's draw list, without windows or input: labels and figures.
#pragma once

#include <imgui.h>

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <tuple>
#include <vector>

#include "render/plot/typeface.hpp"
#include "render/ui/imgui_painter.hpp"

namespace unfurl {

// Has an ImGui context of its own, current only between begin() and end(). Needs a current GlContext
// throughout.
//
//     sheet.need("text");                       // before begin()
//     ImFont* small = sheet.font(14);
//     ImDrawList& list = sheet.begin(1280, 720);
//     list.AddText(small, 14, {10, 10}, color, "text");
//     sheet.end();                              // painted into the bound framebuffer
class Sheet {
 public:
  Sheet();
  ~Sheet();
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  // The font for lines of `pixels` height, valid as long as the sheet. Only outside begin() and end().
  ImFont* font(float pixels, bool bold = false);
  ImFont* plot_font(float pixels);  // of plot::typeface()
  // Characters of this text that fonts do not have from the start are drawn, too, where a font file has them.
  // Only outside begin() and end().
  void need(std::string_view text);
  ImDrawList& begin(int width, int height);
  void end();

 private:
  ImFont* font_of(float pixels, bool bold, const plot::Typeface& face);

  ImguiPainter painter_;
  ImGuiContext* context_ = nullptr;
  ImGuiContext* outer_ = nullptr;  // what was current before begin()
  // By size in 1/64 pixels, weight and typeface.
  std::map<std::tuple<int, bool, const plot::Typeface*>, ImFont*> fonts_;
  std::set<char32_t> needed_;
  std::deque<std::vector<ImWchar>> ranges_;  // of each text that needed some: they stay where they are
  bool fonts_changed_ = true;
};

}  // namespace unfurl
