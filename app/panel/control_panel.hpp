// SPDX-License-Identifier: BSD-3-Clause
// The interactive panel: scene, view, figures and timeline in one picture. Knows no window: events come in,
// pictures go out, so that a test can drive it without a display.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include "app/panel/input_event.hpp"
#include "app/panel/panel_state.hpp"
#include "app/panel/panes/figure_cards.hpp"
#include "app/panel/panes/ui.hpp"
#include "app/panel/runs/error_meter.hpp"
#include "app/panel/runs/export_process.hpp"
#include "app/panel/runs/study_job.hpp"
#include "app/panel/settings.hpp"
#include "app/panel/view/scene_view.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/ui/draw_damage.hpp"
#include "render/ui/imgui_painter.hpp"

namespace unfurl {

// Where the time of a frame went [s].
struct FrameTimes {
  double scene = 0, figures = 0, widgets = 0, painting = 0;
};

struct PanelOptions {
  int width = 1280, height = 720;  // [pixels]
  float scale = 1;                 // pixels per point of a screen with 96 dpi
  PanelSettings settings;          // window size aside
  double at = 0;                   // of the motion, at first [s]
  bool measure_errors = true;      // of positions, against references
  bool measured = false;           // wait for the graphics after every part, so that frame_times() is true
  std::function<void()> wake;      // called by the simulating thread when there is news
  std::function<void(const char*)> set_clipboard;
  std::function<std::string()> get_clipboard;
};

class ControlPanel {
 public:
  // The context must outlive the panel and be current. Throws SceneError where the scene is not sound at the
  // start, GraphicsError.
  ControlPanel(GlContext& context, SceneDocument document, PanelOptions options);
  ~ControlPanel();
  ControlPanel(const ControlPanel&) = delete;
  ControlPanel& operator=(const ControlPanel&) = delete;

  void resize(int width, int height);
  void handle(const InputEvent& event) { events_.push_back(event); }
  // Take input, move on by `seconds`, draw. Returns whether another frame is wanted without further input:
  // the motion plays, events wait, or widgets settle.
  // A panel that nobody can see is not painted.
  bool frame(double seconds, bool visible = true);
  // Frames until nothing simulates, errors are measured, and the widgets have their sizes: for pictures
  // without a window.
  void settle();
  const Framebuffer& picture() const { return *picture_; }
  const FrameTimes& frame_times() const { return times_; }  // of the last frame

  PanelState& state() { return state_; }
  PanelSettings settings();  // as they are now, to be remembered
  // Where a widget was drawn in the last frame, by its key; throws std::out_of_range.
  const plot::Rect& place(const std::string& key) const { return ui_.places.at(key); }
  bool has_place(const std::string& key) const { return ui_.places.contains(key); }
  bool simulating() const { return simulator_.busy(); }
  const ErrorMeter& errors() const { return errors_; }
  long simulations() const { return simulator_.started(); }
  long view_paints() const { return view_.paints(); }
  OrbitCamera framed() const { return view_.framed(); }  // the film's own camera

 private:
  void make_context();
  void make_fonts();
  void take_events();
  void apply(const InputEvent& event);
  void take_results();
  void take_errors();
  void follow_document();
  void update_picture();
  void draw_panes();
  void draw_splitter(const char* name, float x, float top, float bottom, float& width, float way);
  bool coarse_view(double seconds);
  void paint(bool coarse);
  template <class Part>
  void survive(const Part& part);
  // Runs a part of a frame and adds its time to `sum`.
  template <class Part>
  void timed(double& sum, const Part& part);

  GlContext& context_;
  PanelOptions options_;
  PanelState state_;
  struct ImguiEnd {
    void operator()(ImGuiContext* imgui) const { ImGui::DestroyContext(imgui); }
  };
  std::unique_ptr<ImGuiContext, ImguiEnd> imgui_;
  DrawDamage damage_;
  int slow_frames_ = 0;  // in a row, while something moves
  std::unique_ptr<ImguiPainter> painter_;
  std::unique_ptr<Framebuffer> picture_;
  Ui ui_;
  std::map<int, ImFont*> figure_fonts_;  // by size in 1/64 pixels
  SceneView view_;
  FigureCards cards_;
  std::deque<InputEvent> events_;
  plot::Rect view_place_;  // [pixels]
  bool dark_drawn_ = false;
  int settling_ = 3;  // frames until new widgets have their sizes
  std::optional<SceneDocument> submitted_;
  std::string clipboard_;
  FrameTimes times_;
  std::pair<bool, bool> jobs_;  // a study, an export ran in the last frame
  ExportProcess export_;
  StudyJob study_;
  ErrorMeter errors_;
  Simulator simulator_;  // last: ends before what it wakes
};

}  // namespace unfurl
