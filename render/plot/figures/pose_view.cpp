// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/pose_view.hpp"

#include <cmath>

namespace unfurl {

PoseView pose_view(const Vec3& extent) {
  const double thin = 1e-6 * extent.maxCoeff();
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  if (extent.y() <= thin) return {x, z, -y, true};
  if (extent.x() <= thin) return {y, z, x, true};
  if (extent.z() <= thin) return {x, y, z, true};
  const double azimuth = -70 * radians_per_degree, elevation = 24 * radians_per_degree;
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation),
               se = std::sin(elevation);
  return {{-sa, ca, 0}, {-se * ca, -se * sa, ce}, {ce * ca, ce * sa, se}};
}

}  // namespace unfurl
