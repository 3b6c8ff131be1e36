// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/view/film_camera.hpp"

#include <algorithm>
#include <cmath>

#include "app/panel/view/view_style.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

namespace {

// Half of the height that a camera sees at its target [m].
double reach(const OrbitCamera& orbit) {
  return orbit.distance * std::tan(0.5 * orbit.field_of_view);
}

// Half of the height that the view of a film with these keys, at a zoom of 1, sees at its target [m].
double film_reach(const PanelState& state, std::vector<CameraKey> keys) {
  RenderOptions still = state.picture;
  still.follow = false;
  still.orbit = still.turntable = 0;
  for (CameraKey& key : keys) key.zoom = 1;
  still.camera_keys = std::move(keys);
  const Camera camera = FrameBuilder(state.shown->simulation.trajectory, view_style(state, still)).camera();
  return camera.parallel_height > 0 ? 0.5 * static_cast<double>(camera.parallel_height)
                                    : reach(orbit_of(camera));
}

double in_degrees(float radians) {
  return std::round(10 * static_cast<double>(radians) / radians_per_degree) / 10;
}

// Of a key's time [s]: a power of ten that is 1e-5 of the motion's duration at most; 1e-4 s of motions of
// seconds.
double time_unit(const LiveRun& run) {
  const Trajectory& motion = run.simulation.trajectory;
  const double duration = motion.end_time() - motion.start_time();
  return duration > 0 ? std::pow(10.0, std::min(-4.0, std::floor(std::log10(duration)) - 4)) : 1e-4;
}

double rounded_time(double t, const LiveRun& run) {
  const double per_second =
      std::round(1 / time_unit(run));  // a whole number: the quotient is the nearest decimal
  return std::round(per_second * t) / per_second;
}

std::string key_text(const CameraKey& key) {
  return "{time = " + toml_value(key.time) + ", azimuth = " + toml_value(key.azimuth) +
         ", elevation = " + toml_value(key.elevation) + ", zoom = " + toml_value(key.zoom) + "}";
}

}  // namespace

OrbitCamera film_view(const PanelState& state) {
  const Camera camera = FrameBuilder(state.shown->simulation.trajectory, view_style(state, state.picture))
                            .build(state.playback.t)
                            .camera;
  OrbitCamera orbit = orbit_of(camera);
  if (camera.parallel_height > 0)
    orbit.distance = 0.5f * camera.parallel_height / std::tan(0.5f * orbit.field_of_view);
  return orbit;
}

namespace {

std::vector<CameraKey> keys_with(std::vector<CameraKey> others, const PanelState& state,
                                 const OrbitCamera& orbit, double t) {
  const double before = others.empty() ? 0 : film_reach(state, others);
  const double at_once = 0.01 * time_unit(*state.shown);
  std::erase_if(others, [&](const CameraKey& key) { return std::abs(key.time - t) < at_once; });
  CameraKey key{t, in_degrees(orbit.azimuth), std::clamp(in_degrees(orbit.elevation), -90.0, 90.0), 1};
  std::vector<CameraKey> keys = others;
  keys.insert(std::upper_bound(keys.begin(), keys.end(), t,
                               [](double at, const CameraKey& other) { return at < other.time; }),
              key);
  const double after = film_reach(state, keys);
  for (CameraKey& each : keys) {
    const double zoom = each.time == t ? after / reach(orbit) : each.zoom * after / before;
    each.zoom = std::clamp(std::round(1000 * zoom) / 1000, 0.05, 50.0);
  }
  return keys;
}

}  // namespace

SceneDocument with_camera(const PanelState& state, const OrbitCamera& orbit, bool only) {
  const RenderOptions& picture = state.picture;
  SceneDocument document = state.history.now();
  const double at = only ? 0.0 : rounded_time(state.playback.t, *state.shown);
  std::string list;
  for (const CameraKey& key :
       keys_with(only ? std::vector<CameraKey>() : picture.camera_keys, state, orbit, at))
    list += (list.empty() ? "" : ", ") + key_text(key);
  std::erase_if(document.added,
                [](const std::string& text) { return text.starts_with("render.camera_keys="); });
  document.added.push_back("render.camera_keys=[" + list + "]");
  if (picture.follow) document.edits["render.follow"] = false;
  if (picture.orbit != 0) document.edits["render.orbit"] = 0.0;
  if (picture.turntable != 0) document.edits["render.turntable"] = 0.0;
  return document;
}

}  // namespace unfurl
