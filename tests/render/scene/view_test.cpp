// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/view.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "render/scene/framing.hpp"

using namespace unfurl;

namespace view_test {

namespace {

// Ten metres in front of the origin, looking along +y; 90 degrees high.
Camera plain_camera() {
  Camera camera;
  camera.eye = {0, -10, 0};
  camera.target = {0, 0, 0};
  camera.vertical_field_of_view = 1.57079633f;
  return camera;
}

}  // namespace

TEST_CASE("points appear where a pin-hole camera shows them") {
  // At 10 m and 90 degrees the picture is 20 m high: 400 pixels, 20 for a metre. Floats hold 1e-3 pixels.
  const Camera camera = plain_camera();
  const Vec3f middle = project(camera, 800, 400, {0, 0, 0});
  CHECK(middle.x() == Approx(400).margin(1e-3));
  CHECK(middle.y() == Approx(200).margin(1e-3));
  CHECK(middle.z() == Approx(10).margin(1e-4));
  const Vec3f aside = project(camera, 800, 400, {3, 0, 5});
  CHECK(aside.x() == Approx(460).margin(1e-3));
  CHECK(aside.y() == Approx(100).margin(1e-3));
  const Vec3f far = project(camera, 800, 400, {3, 10, 5});  // twice as far, half as large
  CHECK(far.x() == Approx(430).margin(1e-3));
  CHECK(far.y() == Approx(150).margin(1e-3));
  CHECK(project(camera, 800, 400, {0, -11, 0}).z() < 0);
}

TEST_CASE("the light sees its whole sphere and nothing outside") {
  const Vec3f center(1, 2, 3), direction(0.3f, -0.4f, 0.8f);
  const Eigen::Matrix4f light = light_projection(direction, center, 5);
  const auto at = [&](const Vec3f& p) { return Vec3f((light * p.homogeneous()).head<3>()); };
  CHECK(at(center).norm() == Approx(0).margin(1e-5));
  for (const Vec3f& axis : {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1), Vec3f(1, -1, 1)}) {
    CHECK(at(center + 5 * axis.normalized()).norm() == Approx(1).margin(1e-5));
  }
  CHECK(at(center + 2 * direction.normalized()).z() == Approx(-0.4).margin(1e-5));  // nearer to the light
}

// With room for an inset on the left the middle lies right of the picture's: nearer by, it does so by as
// much.
TEST_CASE("what is in the middle of a motion stays in its place whatever the zoom") {
  const std::vector<Vec3> corners = {{-1, -0.3, -0.5}, {1, -0.3, -0.5}, {-1, 0.3, 0.5}, {1, 0.3, 0.5}};
  const PointSource points = [&](const std::function<void(const Vec3&)>& visit) {
    for (const Vec3& p : corners) visit(p);
  };
  const MotionBounds bounds = motion_bounds(points);
  for (const bool parallel : {false, true}) {
    Framing framing;
    framing.parallel = parallel;
    framing.margins = {0.35, 0.05, 0.2, 0.1};
    Vec3f first;
    for (const double zoom : {1.0, 3.0, 5.0}) {
      framing.zoom = zoom;
      const Camera camera = frame_points(points, bounds.center, bounds, {-1.2, 0.3}, framing);
      const Vec3f at = project(camera, 1600, 900, bounds.center.cast<float>());
      if (zoom == 1) first = at;
      CAPTURE(parallel, zoom);
      CHECK(at.x() > 850);
      CHECK(at.x() == Approx(first.x()).margin(0.1));  // pixels, in single precision
      CHECK(at.y() == Approx(first.y()).margin(0.1));
    }
  }
}

}  // namespace view_test
