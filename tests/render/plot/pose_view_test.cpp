// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/pose_view.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace unfurl;

namespace pose_view_test {

// Gravity points down on the page, straight where it acts in the page, and the page is never a mirror.
TEST_CASE("poses stand upright in figures, whatever axis is up in the scene") {
  for (const Vec3& gravity :
       {Vec3(0, 0, -9.81), Vec3(0, -9.81, 0), Vec3(-1.6, 0, 0), Vec3(0, 0, 3), Vec3(1, -2, 4)})
    for (const Vec3& extent : {Vec3(2, 3, 4), Vec3(2, 3, 0), Vec3(0, 3, 4), Vec3(2, 0, 4)}) {
      CAPTURE(gravity.transpose(), extent.transpose());
      const PoseView view = pose_view(extent, gravity);
      const Vec3 down = view.project(gravity.normalized());
      CHECK((view.right.cross(view.up) - view.towards).norm() < 1e-12);
      CHECK(view.flat == (extent.minCoeff() == 0));
      CHECK(std::abs(down.x()) < 1e-12);
      CHECK(down.y() < 1e-12);
      if (!view.flat) CHECK(down.y() < -0.9);
    }
  // Without gravity, or with gravity across the page: z is up, or y where z has no extent.
  CHECK(pose_view({2, 3, 4}, Vec3::Zero()).up.z() > 0.9);
  CHECK(pose_view({2, 0, 4}, Vec3::Zero()).up == Vec3::UnitZ());
  CHECK(pose_view({2, 3, 0}, {0, 0, -9.81}).up == Vec3::UnitY());
}

}  // namespace pose_view_test
