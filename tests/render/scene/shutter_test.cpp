// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/shutter.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/gl/context.hpp"

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

}  // namespace

TEST_CASE("what moves before nothing is blurred, and keeps its colour") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'P'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'E'\nposition = [2, 0, 0]\nvelocity = [0, 0, 3]\n[[structure.rods]]\n"
      "nodes = ['P', 'E']\nmass = 3\n[solver]\nstep = 0.01\nend_time = 1\n",
      "spin.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  FrameStyle style;
  style.width = 480, style.height = 320;
  style.labels = false;
  style.options.look = "print";
  style.options.material = "paint";
  const FrameBuilder builder(run.trajectory, style);
  const auto context = make_offscreen_context();
  Renderer renderer(*context, style.width, style.height);
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

}  // namespace shutter_test
