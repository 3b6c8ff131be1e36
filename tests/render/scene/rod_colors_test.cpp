// SPDX-License-Identifier: BSD-3-Clause
// Every rod shows the colour of its group, from every side and in every light of a deployment.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace rod_colors_test {

namespace {

constexpr int width = 960, height = 540;

// Degrees around the colour wheel; red is 0.
float hue(float r, float g, float b) {
  const float high = std::max({r, g, b}), chroma = high - std::min({r, g, b});
  if (chroma <= 0) return 0;
  const float sixth = high == r ? (g - b) / chroma : high == g ? (b - r) / chroma + 2 : (r - g) / chroma + 4;
  return std::fmod(60 * sixth + 360, 360.0f);
}

float hue_at(const Image& image, const Vec3f& pixel) {
  const auto i = 4 * (static_cast<std::size_t>(pixel.y()) * width + static_cast<std::size_t>(pixel.x()));
  return hue(image.rgba.at(i), image.rgba.at(i + 1), image.rgba.at(i + 2));
}

float hue_distance(float a, float b) {
  return std::abs(std::remainder(a - b, 360.0f));
}

// How far a pixel is from the rods other than `own` in the picture.
float distance_to_others(const DrawList& list, std::size_t own, const Vec3f& pixel) {
  float least = 1e9f;
  for (std::size_t i = 0; i < list.tubes.size(); ++i) {
    if (i == own) continue;
    const Eigen::Vector2f a = project(list.camera, width, height, list.tubes[i].a).head<2>();
    const Eigen::Vector2f b = project(list.camera, width, height, list.tubes[i].b).head<2>();
    const Eigen::Vector2f p = pixel.head<2>();
    const float u = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0f, 1.0f);
    least = std::min(least, (a + u * (b - a) - p).norm());
  }
  return least;
}

}  // namespace

TEST_CASE("every rod has the hue of its group wherever it is seen alone") {
  const Scene scene = read_scene_text(
      "structure.kind = \"hoop\"\nstructure.fold_angle = 85.0\n"
      "structure.hinge_force = 200.0\nsolver.end_time = 10.0\n",
      "ring.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::deployed);
  FrameStyle style;
  style.width = width, style.height = height;
  style.loads = style.labels = false;
  const FrameBuilder builder(run.trajectory, style);
  const auto context = make_offscreen_context();
  Renderer renderer(*context, width, height);
  int looked = 0;
  for (int k = 0; k <= 24; ++k) {  // the second half, where rods lie apart
    const DrawList list = builder.build(run.trajectory.end_time() * (0.7 + 0.3 * k / 24));
    const Image image = renderer.draw(list);
    for (std::size_t i = 0; i < list.tubes.size(); ++i) {
      const Tube& tube = list.tubes[i];
      for (float u = 0.26f; u < 0.75f; u += 0.04f) {
        const Vec3f pixel = project(list.camera, width, height, tube.a + u * (tube.b - tube.a));
        if (distance_to_others(list, i, pixel) < 12) continue;  // fittings are up to 10 pixels thick
        INFO("frame " << k << ", rod " << i << " at " << u);
        // The lamp's warm light and the reflected room turn the hue by less than 20 degrees; the two groups
        // are 170 degrees apart.
        CHECK(hue_distance(hue_at(image, pixel), hue(tube.color.r, tube.color.g, tube.color.b)) < 25);
        ++looked;
      }
    }
  }
  CHECK(looked > 25 * 30 * 5);  // most of the rods' middles are free
}

}  // namespace rod_colors_test
