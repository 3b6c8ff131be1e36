// SPDX-License-Identifier: BSD-3-Clause
// A sheet to draw on with ImGui's draw list, without windows or input: labels and figures.
#pragma once

#include <imgui.h>

#include <map>
#include <memory>
#include <tuple>

#include "render/plot/typeface.hpp"
#include "render/ui/imgui_painter.hpp"

namespace unfurl {

// Has an ImGui context of its own, current only between begin() and end(). Needs a current GlContext
// throughout.
//
//     ImFont* small = sheet.font(14);           // before begin()
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
  ImDrawList& begin(int width, int height);
  void end();

 private:
  ImFont* font_of(float pixels, bool bold, const plot::Typeface& face);

  ImguiPainter painter_;
  ImGuiContext* context_ = nullptr;
  ImGuiContext* outer_ = nullptr;  // what was current before begin()
  // By size in 1/64 pixels, weight and typeface.
  std::map<std::tuple<int, bool, const plot::Typeface*>, ImFont*> fonts_;
  bool fonts_changed_ = true;
};

}  // namespace unfurl
