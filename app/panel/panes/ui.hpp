// SPDX-License-Identifier: BSD-3-Clause
// What the panes share while a frame is drawn.
#pragma once

#include <imgui.h>

#include <exception>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "app/panel/panes/theme.hpp"
#include "render/plot/canvas.hpp"

namespace unfurl {

struct Ui {
  float scale = 1;  // pixels per point of a screen with 96 dpi
  Theme theme;
  ImFont *regular = nullptr, *bold = nullptr, *small = nullptr;
  std::function<ImFont*(float pixels)> figure_font;
  std::map<std::string, plot::Rect> places;  // where each widget is, by key: for tests [pixels]

  // Lines at the present time, over the figures. In a list of their own: what moves is small.
  std::vector<plot::Rect> cursors;  // [pixels]

  // The field into which a number is typed, and the value that it began with: what Esc, and what is no
  // number, lead back to.
  struct TypedField {
    ImGuiID id = 0;
    double began = 0;
    bool drawn = false;  // in this frame
  } typed;

  // Boxes are as high as their contents were in the frame before: another frame is wanted where these
  // changed.
  std::map<std::string, float> box_ends;  // [pixels]
  bool unsettled = false;

  float px(float points) const { return points * scale; }
  ImU32 color(const ImVec4& c, float alpha = 1) const {
    return ImGui::ColorConvertFloat4ToU32(ImVec4(c.x, c.y, c.z, c.w * alpha));
  }
  // Note the last widget's place.
  void note(const std::string& key) {
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    places[key] = {a.x, a.y, b.x, b.y};
  }
};

// A window that fills a rectangle of the panel. Where an exception passes, ImGui closes what is open, in its
// order (ImguiHost::frame).
class Pane {
 public:
  Pane(const char* name, float x, float y, float width, float height, ImGuiWindowFlags flags = 0);
  ~Pane();
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;

 protected:
  Pane() = default;
  int before_ = std::uncaught_exceptions();
};

// A window over the others, in their middle or (`top`) below the top bar; as wide as that [points], 0: as its
// contents. Its place is noted as "NAME box".
class Box : public Pane {
 public:
  Box(Ui& ui, const char* name, float width, bool top = false);
  ~Box();
  float width() const { return ImGui::GetContentRegionAvail().x; }
  void heading(const char* text) const;

 private:
  Ui& ui_;
  std::string name_;
};

// The text with room behind it for as much again to be typed, and its end.
std::vector<char> typing_room(const std::string& text);
// A line of text to type; true where it changed.
bool text_field(Ui& ui, const std::string& key, std::string& value, float width, const char* hint = "",
                ImGuiInputTextFlags flags = 0, ImGuiInputTextCallback callback = nullptr);

void tooltip(const Ui& ui, const std::string& text);  // over the last widget

// The text, cut with an ellipsis where it is wider in the present font [pixels].
std::string shortened(const std::string& text, float width);

void wrapped(const ImVec4& color, const std::string& text);  // over as many lines as it takes

// On a ground of its own, in lines of at most `room` [pixels; 0: in one]; where that is.
plot::Rect text_on_ground(const Ui& ui, const ImVec2& at, const char* text, float opaque, float room = 0);

// A button of the panel; greyed out where it is not enabled.
bool button(Ui& ui, const std::string& key, const std::string& label, const std::string& help,
            bool enabled = true);

}  // namespace unfurl
