// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/view/scene_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/panel/view/view_style.hpp"

namespace unfurl {

namespace {

// The other run, which counts `from` another origin: thinner, all in one pale colour, so that nobody takes it
// for the present one.
void add_ghost(const DrawList& other, const Vec3f& from, DrawList& list) {
  const Color pale = mixed({0.48f, 0.31f, 0.64f, 1}, list.background_top, 0.45f);
  for (Tube tube : other.tubes) {
    tube.a += from, tube.b += from;
    tube.color = pale;
    tube.radius *= 0.55f;
    list.tubes.push_back(tube);
  }
}

float lightness(const Color& c) {
  return 0.3f * c.r + 0.6f * c.g + 0.1f * c.b;
}

// The studio at night: what is written over the picture changes its lightness with the background.
void darken(DrawList& list) {
  list.background_top = {0.16f, 0.19f, 0.23f, 1};
  list.background_bottom = {0.27f, 0.31f, 0.36f, 1};
  // Ink becomes nearly white; what is coloured stays recognisable, as a legend's swatch must.
  const auto light = [](Color& c) {
    const float chroma = std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b});
    if (lightness(c) < 0.5f) c = mixed(c, {1, 1, 1, 1}, chroma > 0.3f ? 0.35f : 0.75f);
  };
  const auto dark = [](Color& c) {
    const float alpha = c.a;
    if (lightness(c) > 0.5f) c = {0.14f, 0.17f, 0.20f, alpha};
  };
  for (TextLabel& label : list.labels) {
    light(label.color);
    dark(label.backing);
  }
  for (OverlayLine& line : list.lines) light(line.color);
  const auto is_sign = [](const Color& c) {  // of a legend: it is what it stands for
    return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}) > 0.3f;
  };
  for (OverlayArea& area : list.areas)
    if (!is_sign(area.color)) dark(area.color);
}

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.vertical_field_of_view == b.vertical_field_of_view &&
         a.near_plane == b.near_plane && a.far_plane == b.far_plane && a.parallel_height == b.parallel_height;
}

// The film's camera, or the one that is led by hand.
Camera camera_by(const PanelState& state, const Camera& film, const DrawList& list) {
  if (!state.orbit) return film;
  Camera camera = camera_of(*state.orbit, list.center, list.radius);
  if (film.parallel_height > 0)
    camera.parallel_height = 2 * state.orbit->distance * std::tan(0.5f * state.orbit->field_of_view);
  return camera;
}

}  // namespace

bool SceneView::Painted::operator==(const Painted& o) const {
  return run == o.run && ghost == o.ghost && t == o.t && dark == o.dark && coarse == o.coarse &&
         same(camera, o.camera);
}

void SceneView::rebuild(PanelState& state) {
  run_ = state.shown;
  options_ = state.view;
  picture_ = state.picture;
  painted_ = {};
  heading_ = state.view_place.heading;
  state.picture_problems.clear();
  FrameStyle style = view_style(state, picture_, &state.picture_problems);
  if (builder_) style.origin = builder_->origin();  // the eye stays where it is
  builder_ = std::make_unique<FrameBuilder>(run_->simulation.trajectory, style);
  ghost_.reset();
  if (ghost_run_) {
    FrameStyle plain;
    plain.width = width_;
    plain.height = height_;
    plain.labels = plain.loads = false;
    plain.origin = builder_->origin();
    ghost_ = std::make_unique<FrameBuilder>(ghost_run_->simulation.trajectory, plain);
  }
  build(state);
}

void SceneView::build(const PanelState& state) {
  list_ = builder_->build(
      state.playback.t, [&](const DrawList& films) { return camera_by(state, film_ = films.camera, films); });
  t_ = state.playback.t;
}

void SceneView::prepare(int width, int height, PanelState& state) {
  if (width < 1 || height < 1) return;
  const bool resized = width != width_ || height != height_;
  state.view_place = {width, height, words_, state.view_place.heading};
  dark_ = state.dark;
  if (resized || !renderer_) {
    renderer_.reset();  // its memory first
    renderer_ = std::make_unique<Renderer>(context_, width, height);
    width_ = width;
    height_ = height;
  }
  if (!state.shown || state.shown->simulation.trajectory.empty()) return;
  const auto ghost = state.view.ghost ? state.pinned : nullptr;
  const bool changed = run_ != state.shown || ghost_run_ != ghost || !(options_ == state.view) ||
                       !(picture_ == state.picture) || !(heading_ == state.view_place.heading);
  if (resized || !builder_ || changed) {
    ghost_run_ = ghost;
    rebuild(state);
  } else if (t_ != state.playback.t) {
    build(state);
  }
}

Camera SceneView::camera(const PanelState& state) const {
  return camera_by(state, film_, list_);
}

OrbitCamera SceneView::framed_start() const {
  const Trajectory& trajectory = run_->simulation.trajectory;
  const VectorXd whole = trajectory.positions_at(trajectory.start_time());
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (Index i = 0; i + 2 < whole.size(); i += 3) {
    const Vec3 at = builder_->upright() * whole.segment<3>(i);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  OrbitCamera orbit = framed();
  const auto radius = static_cast<float>((high - low).norm() / 2);
  if (!(radius > 0)) return orbit;  // a point has no size
  orbit.target = ((low + high) / 2).cast<float>();
  const float half_height = orbit.field_of_view / 2,
              aspect = static_cast<float>(width_) / static_cast<float>(std::max(1, height_));
  constexpr float room = 2.5f;  // for what is built beside it
  orbit.distance = room * radius / std::sin(std::min(half_height, std::atan(aspect * std::tan(half_height))));
  return orbit;
}

PickView SceneView::pick_view(const PanelState& state) const {
  return {camera(state), width_, height_, builder_->upright(), builder_->origin()};
}

namespace {

bool is_scale_note(const TextLabel& label) {
  return label.text.starts_with("rods drawn ");
}

}  // namespace

std::string SceneView::scale_note() const {
  const auto at = std::find_if(list_.labels.begin(), list_.labels.end(), is_scale_note);
  return options_.labels || at == list_.labels.end() ? "" : at->text;
}

DrawList SceneView::decorated(const PanelState& state) const {
  DrawList list = list_;
  if (!options_.labels) std::erase_if(list.labels, is_scale_note);
  if (list.transparent) {  // for paper, which is white
    list.transparent = false;
    list.background_top = list.background_bottom = {1, 1, 1, 1};
  }
  if (dark_ && picture_.look == "studio") darken(list);
  if (ghost_)
    add_ghost(ghost_->build(state.playback.t),
              (builder_->upright() * (ghost_->origin() - builder_->origin())).cast<float>(), list);
  return list;
}

bool SceneView::moved(const PanelState& state) const {
  return builder_ && (t_ != painted_.t || !same(camera(state), painted_.camera));
}

bool SceneView::paint(const PanelState& state, bool coarse) {
  if (!builder_) return false;
  const Painted wanted{run_.get(), ghost_run_.get(), t_, camera(state), dark_, coarse};
  if (wanted == painted_) return false;
  if (builder_->writes_by_camera() && !same(wanted.camera, list_.camera)) build(state);
  list_.camera = wanted.camera;
  renderer_->paint(decorated(state), coarse);
  painted_ = wanted;
  ++paints_;
  return true;
}

void SceneView::copy_to(const Framebuffer& target, int x, int y) const {
  if (renderer_ && builder_) renderer_->picture().copy_to(target, x, y);
}

}  // namespace unfurl
