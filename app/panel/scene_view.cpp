#include "app/panel/scene_view.hpp"

namespace unfurl {

namespace {

Color mixed(const Color& a, const Color& b, float share) {
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b), 1};
}

// The other run: thinner, all in one pale colour, so that nobody takes it for the present one.
void add_ghost(const DrawList& other, DrawList& list) {
  const Color pale = mixed({0.48f, 0.31f, 0.64f, 1}, list.background_top, 0.45f);
  for (Tube tube : other.tubes) {
    tube.color = pale;
    tube.radius *= 0.55f;
    list.tubes.push_back(tube);
  }
}

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.vertical_field_of_view == b.vertical_field_of_view &&
         a.near_plane == b.near_plane && a.far_plane == b.far_plane;
}

}  // namespace

bool SceneView::Painted::operator==(const Painted& o) const {
  return run == o.run && ghost == o.ghost && t == o.t && dark == o.dark && same(camera, o.camera);
}

void SceneView::prepare(int width, int height, const PanelState& state, bool dark) {
  if (width < 1 || height < 1) return;
  const bool resized = width != width_ || height != height_;
  dark_ = dark;
  if (resized || !renderer_) {
    renderer_.reset();  // its memory first
    renderer_ = std::make_unique<Renderer>(context_, width, height);
  }
  if (!state.shown || state.shown->simulation.trajectory.empty()) return;
  const auto wanted_ghost = state.view.ghost ? state.pinned : nullptr;
  if (!resized && builder_ && run_ == state.shown && ghost_run_ == wanted_ghost && options_ == state.view)
    return;
  width_ = width;
  height_ = height;
  run_ = state.shown;
  ghost_run_ = wanted_ghost;
  options_ = state.view;
  painted_ = {};
  FrameStyle style;
  style.width = width;
  style.height = height;
  style.title = run_->scene.title;
  style.labels = options_.labels;
  style.loads = options_.loads;
  builder_ = std::make_unique<FrameBuilder>(run_->simulation.trajectory, style);
  style.labels = style.loads = false;
  ghost_ = ghost_run_ ? std::make_unique<FrameBuilder>(ghost_run_->simulation.trajectory, style) : nullptr;
  still_ = builder_->build(run_->simulation.trajectory.start_time());
}

Camera SceneView::camera(const PanelState& state) const {
  return state.orbit ? camera_of(*state.orbit, still_.center, still_.radius) : builder_->camera();
}

PickView SceneView::pick_view(const PanelState& state) const {
  return {camera(state), width_, height_, builder_->upright()};
}

DrawList SceneView::list_of(const PanelState& state) const {
  DrawList list = builder_->build(state.playback.t);
  list.camera = camera(state);
  if (dark_) {
    list.background_top = {0.16f, 0.19f, 0.23f, 1};
    list.background_bottom = {0.27f, 0.31f, 0.36f, 1};
  }
  if (ghost_) add_ghost(ghost_->build(state.playback.t), list);
  return list;
}

bool SceneView::paint(const PanelState& state) {
  if (!builder_) return false;
  const Painted wanted{run_.get(), ghost_run_.get(), state.playback.t, camera(state), dark_};
  if (wanted == painted_) return false;
  renderer_->paint(list_of(state));
  painted_ = wanted;
  ++paints_;
  return true;
}

void SceneView::copy_to(const Framebuffer& target, int x, int y) const {
  if (renderer_ && builder_) renderer_->picture().copy_to(target, x, y);
}

}  // namespace unfurl
