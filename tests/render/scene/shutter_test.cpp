// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/shutter.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/gl/context.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace shutter_test {

namespace {

// The mean colour of pixels that cover so much of the ground.
std::array<double, 3> mean_color(const Image& image, int least, int most) {
  std::array<double, 3> sum{};
  double count = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    if (image.rgba[i + 3] < least || image.rgba[i + 3] > most) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += image.rgba[i + c];
    ++count;
  }
  REQUIRE(count > 50);
  for (double& c : sum) c /= count;
  return sum;
}

// A rod of 2 m that turns about its end at 1.5 rad/s, in a line drawing.
struct SpinningRod {
  explicit SpinningRod(const std::string& section) : run(run_of(section)) {
    style.width = 480, style.height = 320;
    style.labels = false;
    style.options.look = "print";
  }
  static Simulation run_of(const std::string& section) {
    const Scene scene = read_scene_text(
        "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'P'\nposition = [0, 0, 0]\nfixed = true\n"
        "[[structure.nodes]]\nname = 'E'\nposition = [2, 0, 0]\nvelocity = [0, 0, 3]\n[[structure.rods]]\n"
        "nodes = ['P', 'E']\nmass = 3\n" +
            section + "[solver]\nstep = 0.01\nend_time = 1\n",
        "spin.toml");
    return simulate(build_model(scene), scene.solver);
  }

  Simulation run;
  FrameStyle style;
};

}  // namespace

TEST_CASE("what moves before nothing is blurred, and keeps its colour") {
  SpinningRod rod("");
  rod.style.options.material = "paint";
  const FrameBuilder builder(rod.run.trajectory, rod.style);
  const auto context = make_offscreen_context();
  Renderer renderer(*context, rod.style.width, rod.style.height);
  Shot shot{0.4, 0.4, 0};
  const auto sharp = mean_color(exposed(renderer, builder, shot, 0), 250, 255);
  shot.open = 0.15;
  const Image blurred = exposed(renderer, builder, shot, 0);
  for (const auto& [least, most] : {std::pair{40, 110}, {110, 200}}) {
    const auto pale = mean_color(blurred, least, most);
    // Shading from side to side of a rod; multiplied by what they cover colours were a quarter and a half of
    // it.
    for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(pale[c] - sharp[c]) < 0.25 * sharp[c] + 12);
  }
}

// A rod that turns by 0.75 rad while the shutter is open: its end goes fifty times its thickness.
TEST_CASE("what moves fast leaves one blur, not pictures beside each other") {
  SpinningRod rod("area = 1e-4\n");
  rod.style.options.camera = "front";
  const FrameBuilder builder(rod.run.trajectory, rod.style);
  const auto context = make_offscreen_context();
  Renderer renderer(*context, rod.style.width, rod.style.height);
  Shot shot{0, 0, 0};
  shot.open = 0.5;
  const Image image = exposed(renderer, builder, shot, 0);
  int covered = 0;
  constexpr int places = 400;
  for (int k = 0; k < places; ++k) {  // nine tenths out, where the rod was at that time
    const double t = shot.open * (0.1 + 0.8 * k / places);
    const VectorXd at = rod.run.trajectory.positions_at(t);
    const Vec3f p = (builder.upright() * (0.9 * at.tail<3>() - builder.origin())).cast<float>();
    const Vec3f pixel = project(builder.build(shot).camera, rod.style.width, rod.style.height, p);
    const auto x = static_cast<std::size_t>(pixel.x()), y = static_cast<std::size_t>(pixel.y());
    covered += image.rgba[4 * (y * static_cast<std::size_t>(rod.style.width) + x) + 3] > 0;
  }
  CHECK(covered == places);
}

}  // namespace shutter_test
