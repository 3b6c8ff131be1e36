// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/pose_view.hpp"

#include <cmath>

#include "core/export/upright.hpp"

namespace unfurl {

namespace {

// Along `towards`; the other way up where gravity, as far as it acts in the page, says so.
PoseView flat_view(const Vec3& up, const Vec3& towards, const Vec3& gravity) {
  const Vec3 in_page = gravity - towards * towards.dot(gravity);
  const Vec3 upward = in_page.norm() > 0.1 * gravity.norm() ? Vec3(-in_page.normalized()) : up;
  return {upward.cross(towards), upward, towards, true};
}

}  // namespace

PoseView pose_view(const Vec3& extent, const Vec3& gravity) {
  const double thin = 1e-6 * extent.maxCoeff();
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  if (extent.y() <= thin) return flat_view(z, -y, gravity);
  if (extent.x() <= thin) return flat_view(z, x, gravity);
  if (extent.z() <= thin) return flat_view(y, z, gravity);
  const double azimuth = -70 * radians_per_degree, elevation = 24 * radians_per_degree;
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
               se = std::sin(elevation);
  const Mat3 back = upright_rotation(gravity).transpose();
  return {back * Vec3(-sa, ca, 0), back * Vec3(-se * ca, -se * sa, ce), back * Vec3(ce * ca, ce * sa, se)};
}

}  // namespace unfurl
