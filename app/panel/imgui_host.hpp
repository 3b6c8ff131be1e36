// SPDX-License-Identifier: BSD-3-Clause
// ImGui without a window of its own: its context, fonts, clipboard and input, and frames that survive what is
// thrown in them.
#pragma once

#include <imgui.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "app/panel/input_event.hpp"
#include "app/panel/panes/ui.hpp"
#include "render/ui/imgui_painter.hpp"

namespace unfurl {

struct Clipboard {  // of the desktop; empty: the panel has one of its own
  std::function<void(const char*)> set;
  std::function<std::string()> get;
};

class ImguiHost {
 public:
  // A graphics context must be current, here and when it goes.
  ImguiHost(float scale, Clipboard clipboard);
  ImguiHost(const ImguiHost&) = delete;
  ImguiHost& operator=(const ImguiHost&) = delete;

  void make_current() const { ImGui::SetCurrentContext(context_.get()); }
  void apply(const InputEvent& event);
  bool typing() const { return ImGui::GetIO().WantTextInput; }
  void leave_field() const;  // where text is typed; what was typed stays
  // The widget that has the keyboard, where one has, uses this key.
  bool widget_takes(Key key) const;
  // Gives the keyboard to the widgets of a pane: the left one, or (`next`) the one behind that which has it.
  void focus_pane(bool next);
  bool close_popups() const;  // true: one was open
  // A frame: `draw` makes its widgets. What it throws passes when the frame is whole and the next can be
  // drawn.
  void frame(int width, int height, double seconds, const std::function<void()>& draw);

  Ui& ui() { return ui_; }
  const Ui& ui() const { return ui_; }
  ImguiPainter& painter() { return *painter_; }

 private:
  void make_fonts();
  void judge_clicks(double seconds);
  void forget_left_field();
  void tab_from_left_field() const;

  struct End {
    void operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }
  };
  std::unique_ptr<ImGuiContext, End> context_;
  std::unique_ptr<ImguiPainter> painter_;
  Clipboard clipboard_;
  std::string copied_;
  std::map<int, ImFont*> figure_fonts_;  // by size in 1/64 pixels
  Ui ui_;
  ImGuiID typed_ = 0;                              // the field that was typed into last
  int pane_ = -1;                                  // that was given the keyboard last
  double pressed_[3] = {-1, -1, -1}, since_ = -1;  // when buttons were; the last press after the one before
  double frame_seconds_ = 0;                       // of the last frame
};

}  // namespace unfurl
