// SPDX-License-Identifier: BSD-3-Clause
// The interactive panel: scene, view, figures and timeline in one picture. Knows no window: events come in,
// pictures go out, so that a test can drive it without a display.
#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <memory>

#include "app/panel/imgui_host.hpp"
#include "app/panel/live_session.hpp"
#include "app/panel/panes/figure_cards.hpp"
#include "app/panel/session_log.hpp"
#include "app/panel/settings.hpp"
#include "app/panel/view/scene_view.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/ui/draw_damage.hpp"

namespace unfurl {

// Where the time of a frame went [s].
struct FrameTimes {
  double scene = 0, figures = 0, widgets = 0, painting = 0;
};

struct PanelOptions {
  int width = 1280, height = 720;     // [pixels]
  float scale = 1;                    // pixels per point of a screen with 96 dpi
  PanelSettings settings;             // window size aside
  double at = 0;                      // of the motion, at first [s]
  bool measure_errors = true;         // of positions, against references
  double moment = Simulator::moment;  // a run that takes longer is told of while it lasts [s]
  bool measured = false;              // wait for the graphics after every part, so that frame_times() is true
  std::function<void()> wake;         // called by the simulating thread when there is news
  Clipboard clipboard;
  std::string record;     // a file for what is done (session_log.hpp); empty: none
  bool replayed = false;  // what arrives from the work beside is told by such a file
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
  void handle(const InputEvent& event);
  void tell(Arrivals arrivals) { session_.tell(std::move(arrivals)); }

  // Take input, move on by `seconds`, draw. Returns whether another frame is wanted without further input:
  // the motion plays, events wait, or widgets settle.
  // A panel that nobody can see is not painted.
  bool frame(double seconds, bool visible = true);
  // Frames until nothing simulates, errors are measured, and the widgets have their sizes: for pictures
  // without a window.
  void settle();
  const Framebuffer& picture() const { return *picture_; }
  const FrameTimes& frame_times() const { return times_; }  // of the last frame

  PanelState& state() { return session_.state(); }
  PanelSettings settings();  // as they are now, to be remembered
  // Where a widget was drawn in the last frame, by its key; throws std::out_of_range.
  const plot::Rect& place(const std::string& key) const;
  bool has_place(const std::string& key) const { return host_->ui().places.contains(key); }
  const LiveSession& session() const { return session_; }
  LiveSession& session() { return session_; }
  double painted() const { return painted_; }  // so far, parts that were painted again again counted [pixels]
  long view_paints() const { return view_.paints(); }
  // Why the session that was asked for is not recorded to its end.
  void throw_if_not_recorded() const {
    if (record_failure_) std::rethrow_exception(record_failure_);
  }
  OrbitCamera framed() const { return view_.framed(); }  // the film's own camera

 private:
  void take_events();
  bool take_key(const InputEvent& event);
  void draw_panes();
  void draw_right_pane(const plot::Rect& place);
  void draw_splitter(const char* name, float x, float top, float bottom, float& width, float way);
  bool coarse_view(double seconds);
  void paint(bool coarse);
  void survive(const std::function<void()>& part);
  bool record(double seconds, bool visible, bool more);
  // Runs a part of a frame and adds its time to `sum`.
  template <class Part>
  void timed(double& sum, const Part& part);
  void keep_drawing(bool news) { settling_ = std::max(settling_, news ? 2 : 0); }

  GlContext& context_;
  PanelOptions options_;
  LiveSession session_;
  std::unique_ptr<ImguiHost> host_;
  DrawDamage damage_;
  double painted_ = 0;
  int slow_frames_ = 0;  // in a row, while something moves
  int box_frames_ = 0;   // since a box with a text field is open
  std::unique_ptr<Framebuffer> picture_;
  SceneView view_;
  FigureCards cards_;
  std::deque<InputEvent> events_;
  plot::Rect view_place_;  // [pixels]
  std::optional<bool> dark_drawn_;
  int settling_ = 3;  // frames until new widgets have their sizes
  FrameTimes times_;
  std::unique_ptr<SessionRecorder> recorder_;  // null: nothing is recorded
  std::exception_ptr record_failure_;
};

}  // namespace unfurl
