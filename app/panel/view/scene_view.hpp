// SPDX-License-Identifier: BSD-3-Clause
// The 3-D view of a run: the film's own pictures, with a camera led by hand.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include "app/panel/panel_state.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"

namespace unfurl {

class SceneView {
 public:
  // `scale`: how many times as large as usual words shall be at least, as the window's own are.
  SceneView(GlContext& context, float scale) : context_(context), words_(std::max(1.0f, scale)) {}

  // Before anything else of a frame. Cheap where nothing changed.
  void prepare(int width, int height, PanelState& state);
  bool ready() const { return builder_ != nullptr; }
  // Paint where something changed since the last time; returns whether. `coarse`: with jagged edges, in half
  // the time; again, once it is not asked for.
  bool paint(const PanelState& state, bool coarse);
  bool coarse() const { return painted_.coarse; }
  // Does it show another time or stand elsewhere than in the last picture?
  bool moved(const PanelState& state) const;
  void copy_to(const Framebuffer& target, int x, int y) const;

  Camera camera(const PanelState& state) const;
  OrbitCamera framed() const { return orbit_of(film_); }  // the film's own camera
  // Sees the pose at the start whole, from where the film's camera sees the motion.
  OrbitCamera framed_start() const;
  PickView pick_view(const PanelState& state) const;
  // What is not to scale in the picture, which the film writes where the panel has its buttons.
  std::string scale_note() const;
  // The sphere around the whole motion.
  Vec3f center() const { return list_.center; }
  float radius() const { return list_.radius; }
  int width() const { return width_; }
  int height() const { return height_; }
  const DrawList& film_picture() const { return list_; }  // what the film would draw, at its camera
  long paints() const { return paints_; }

 private:
  struct Painted {  // what the last picture showed
    const LiveRun *run = nullptr, *ghost = nullptr;
    double t = 0;
    Camera camera;
    bool dark = false, coarse = false;
    bool operator==(const Painted& o) const;
  };
  void rebuild(PanelState& state);
  void build(const PanelState& state);  // the picture at the present time, as its camera sees it
  DrawList decorated(const PanelState& state) const;

  GlContext& context_;
  float words_;
  CornerRoom heading_;  // that the builder has left free
  std::unique_ptr<Renderer> renderer_;
  std::shared_ptr<const LiveRun> run_, ghost_run_;
  std::unique_ptr<FrameBuilder> builder_, ghost_;
  ViewOptions options_;
  RenderOptions picture_;
  DrawList list_;  // at the time t_
  Camera film_;    // the film's own at that time
  double t_ = 0;
  Painted painted_;
  int width_ = 0, height_ = 0;
  bool dark_ = false;
  long paints_ = 0;
};

}  // namespace unfurl
