// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/view.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace unfurl {
namespace {

using Eigen::Matrix4f;

// Rows: right, up, backward; the camera looks along its own -z.
Matrix4f look_at(const Vec3f& eye, const Vec3f& forward, const Vec3f& up) {
  const Vec3f right = forward.cross(up).normalized();
  const Vec3f upright = right.cross(forward);
  Matrix4f m = Matrix4f::Identity();
  m.block<1, 3>(0, 0) = right.transpose();
  m.block<1, 3>(1, 0) = upright.transpose();
  m.block<1, 3>(2, 0) = -forward.transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye;
  return m;
}

Matrix4f camera_view(const Camera& camera) {
  return look_at(camera.eye, (camera.target - camera.eye).normalized(), camera.up);
}

}  // namespace

Matrix4f view_projection(const Camera& camera, float aspect) {
  const float n = camera.near_plane, f = camera.far_plane;
  if (camera.parallel_height > 0) {
    Matrix4f p = Matrix4f::Identity();
    p(1, 1) = 2.0f / camera.parallel_height;
    p(0, 0) = p(1, 1) / aspect;
    p(2, 2) = 2.0f / (n - f);
    p(2, 3) = (f + n) / (n - f);
    return p * camera_view(camera);
  }
  const float scale = 1.0f / std::tan(0.5f * camera.vertical_field_of_view);
  Matrix4f p = Matrix4f::Zero();
  p(0, 0) = scale / aspect;
  p(1, 1) = scale;
  p(2, 2) = (f + n) / (n - f);
  p(2, 3) = 2 * f * n / (n - f);
  p(3, 2) = -1;
  return p * camera_view(camera);
}

Matrix4f light_projection(const Vec3f& direction, const Vec3f& center, float radius) {
  const Vec3f to_light = direction.normalized();
  const Vec3f up = std::abs(to_light.z()) > 0.9f ? Vec3f::UnitY() : Vec3f::UnitZ();
  Matrix4f p = Matrix4f::Identity();
  p(0, 0) = p(1, 1) = 1.0f / radius;
  p(2, 2) = -1.0f / radius;  // depth 0 in the middle of the sphere
  return p * look_at(center, -to_light, up);
}

Vec3f project(const Camera& camera, int width, int height, const Vec3f& point) {
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  const Eigen::Vector4f clip = view_projection(camera, w / h) * point.homogeneous();
  const float depth = (point - camera.eye).dot((camera.target - camera.eye).normalized());
  return {0.5f * w * (1 + clip.x() / clip.w()), 0.5f * h * (1 - clip.y() / clip.w()), depth};
}

}  // namespace unfurl
