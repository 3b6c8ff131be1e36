// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/view/orbit_camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace unfurl {

namespace {

constexpr float half_turn = 3.14159265f;
constexpr float steepest = 0.495f * half_turn;  // short of straight down, where left and right would be lost

Vec3f direction(const OrbitCamera& orbit) {
  const float c = std::cos(orbit.elevation);
  return {c * std::cos(orbit.azimuth), c * std::sin(orbit.azimuth), std::sin(orbit.elevation)};
}

}  // namespace

OrbitCamera orbit_of(const Camera& camera) {
  OrbitCamera orbit;
  const Vec3f away = camera.eye - camera.target;
  orbit.target = camera.target;
  orbit.distance = std::max(1e-6f, away.norm());
  orbit.azimuth = std::atan2(away.y(), away.x());
  orbit.elevation =
      std::clamp(std::asin(std::clamp(away.z() / orbit.distance, -1.0f, 1.0f)), -steepest, steepest);
  orbit.field_of_view = camera.vertical_field_of_view;
  return orbit;
}

Camera camera_of(const OrbitCamera& orbit, const Vec3f& center, float radius) {
  Camera camera;
  camera.target = orbit.target;
  camera.eye = orbit.target + orbit.distance * direction(orbit);
  camera.vertical_field_of_view = orbit.field_of_view;
  const float away = (camera.eye - center).norm();
  camera.near_plane = std::max(0.004f * radius, 0.3f * (away - radius));
  camera.far_plane = away + 12 * radius;
  return camera;
}

OrbitCamera orbited(OrbitCamera orbit, float dx, float dy, float height) {
  const float turn = half_turn / std::max(1.0f, height);
  orbit.azimuth = std::remainder(orbit.azimuth - dx * turn, 2 * half_turn);
  orbit.elevation = std::clamp(orbit.elevation + dy * turn, -steepest, steepest);
  return orbit;
}

OrbitCamera panned(OrbitCamera orbit, float dx, float dy, float height) {
  const Vec3f forward = -direction(orbit), right = forward.cross(Vec3f::UnitZ()).normalized();
  const float metres = 2 * orbit.distance * std::tan(orbit.field_of_view / 2) / std::max(1.0f, height);
  orbit.target += metres * (dy * right.cross(forward) - dx * right);
  return orbit;
}

OrbitCamera zoomed(OrbitCamera orbit, float steps, const Vec3f& along, float radius) {
  constexpr float range = 1e4f;
  const float before = orbit.distance;
  orbit.distance = std::clamp(before * std::exp(-0.12f * steps), std::min(radius / range, before),
                              std::max(radius * range, before));
  const Vec3f forward = -direction(orbit);
  const float depth = along.dot(forward);
  if (depth > 0.1f) orbit.target += (before - orbit.distance) * (along / depth - forward);
  return orbit;
}

OrbitCamera preset_view(ViewPreset preset, const Vec3f& center, float radius, float aspect,
                        float field_of_view) {
  OrbitCamera orbit;
  orbit.target = center;
  orbit.field_of_view = field_of_view;
  const float half_height = field_of_view / 2, half_width = std::atan(aspect * std::tan(half_height));
  orbit.distance = 1.02f * radius / std::sin(std::min(half_height, half_width));
  orbit.azimuth = -half_turn / 2;
  orbit.elevation = 0;
  if (preset == ViewPreset::side) orbit.azimuth = 0;
  if (preset == ViewPreset::top) orbit.elevation = steepest;
  if (preset == ViewPreset::three_quarter) {
    orbit.azimuth = -62 * half_turn / 180;
    orbit.elevation = 24 * half_turn / 180;
  }
  return orbit;
}

Vec3f ray_through(const Camera& camera, float x, float y, float width, float height) {
  const Vec3f forward = (camera.target - camera.eye).normalized();
  const Vec3f right = forward.cross(camera.up).normalized();
  const float tall = std::tan(camera.vertical_field_of_view / 2), wide = tall * width / height;
  return (forward + right * wide * (2 * x / width - 1) + right.cross(forward) * tall * (1 - 2 * y / height))
      .normalized();
}

}  // namespace unfurl
