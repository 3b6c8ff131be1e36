// SPDX-License-Identifier: BSD-3-Clause
// Drives the panel without a display: events in, frames, pictures out.
#pragma once

#include "app/panel/control_panel.hpp"
#include "render/gl/context.hpp"

namespace unfurl {

class PanelDriver {
 public:
  // `first_start`: with the guided tour.
  explicit PanelDriver(PanelOptions options = small(), const std::string& scene = "hoop6",
                       bool first_start = false)
      : PanelDriver(std::move(options), document(scene), first_start) {}
  PanelDriver(PanelOptions options, SceneDocument scene, bool first_start = false)
      : context_(make_offscreen_context()),
        panel_(*context_, std::move(scene), with_cards(std::move(options), first_start)) {
    settle();
  }

  // The cards that these tests look at are open.
  static PanelOptions with_cards(PanelOptions options, bool first_start) {
    options.settings.open_figures = {"deployment", "trade", "constraint_error"};
    options.settings.tour_seen = !first_start;
    return options;
  }

  // Quick to draw.
  static PanelOptions small() {
    PanelOptions options;
    options.width = 1000;
    options.height = 560;
    options.scale = 0.75f;
    return options;
  }

  ControlPanel& panel() { return panel_; }
  PanelState& state() { return panel_.state(); }

  void frame(double seconds = 1.0 / 60, bool visible = true) { panel_.frame(seconds, visible); }
  void settle() { panel_.settle(); }
  void move(double x, double y) {
    InputEvent event;
    event.x = static_cast<float>(x);
    event.y = static_cast<float>(y);
    panel_.handle(event);
    frame();
  }
  void press(bool down, int button = 0) {
    InputEvent event;
    event.kind = InputEvent::Kind::button;
    event.button = button;
    event.down = down;
    panel_.handle(event);
    frame();
  }
  // share: of the widget's width and height.
  void move_to(const std::string& key, double share_x = 0.5, double share_y = 0.5) {
    const plot::Rect r = panel_.place(key);
    move(r.x0 + share_x * r.width(), r.y0 + share_y * r.height());
  }
  // Until a widget stays where it is: a box is as large as what was in it a frame ago.
  void rest(const std::string& key) {
    for (int i = 0; i < 5; ++i) {
      const plot::Rect before = panel_.place(key);
      frame();
      const plot::Rect now = panel_.place(key);
      if (now.x0 == before.x0 && now.y0 == before.y0) return;
    }
  }
  void click(const std::string& key, int button = 0) {
    rest(key);
    move_to(key);
    press(true, button);
    press(false, button);
    frame();
  }
  void drag(const std::string& key, double from, double to) {
    move_to(key, from);
    press(true);
    for (int i = 1; i <= 8; ++i) move_to(key, from + (to - from) * i / 8);
    press(false);
    frame();
  }
  void key(Key key, bool control = false, bool shift = false) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = key;
    event.control = control;
    event.shift = shift;
    event.down = true;
    panel_.handle(event);
    event.down = false;
    event.control = event.shift = false;
    panel_.handle(event);
    frame();
    frame();
  }
  void type(const std::string& text) {
    InputEvent event;
    event.kind = InputEvent::Kind::text;
    event.text = text;
    panel_.handle(event);
    frame();
  }
  Image picture() { return panel_.picture().read(); }

 private:
  static SceneDocument document(const std::string& scene) {
    SceneDocument result = open_document(scene, {});
    result.overrides = {"solver.step=0.05"};  // quick
    return result;
  }

  std::unique_ptr<GlContext> context_;
  ControlPanel panel_;
};

}  // namespace unfurl
