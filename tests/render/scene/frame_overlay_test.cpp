// SPDX-License-Identifier: BSD-3-Clause
// What is written beside a picture says what is in it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/color_map.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/look.hpp"

using namespace unfurl;

namespace frame_overlay_test {

namespace {

DrawList picture(const std::string& structure, const std::string& render) {
  const Scene scene = read_scene_text(structure + "[render]\n" + render, "ring.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  style.width = 1280, style.height = 720;
  return FrameBuilder(run.trajectory, style).build(2.0);
}

DrawList ring(const std::string& render) {
  return picture("structure.kind = \"hoop\"\nstructure.fold_angle = 85.0\nsolver.end_time = 10.0\n", render);
}

double distance(const Color& a, const Color& b) {
  return std::hypot(static_cast<double>(a.r - b.r), static_cast<double>(a.g - b.g),
                    static_cast<double>(a.b - b.b));
}

// Groups of rods are told apart: so are colours as far from each other as the two groups that are nearest.
double told_apart(const Look& look) {
  double least = 1;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, distance(look.group(i), look.group(j)));
  return least;
}

bool overlap(const TextLabel& a, const TextLabel& b) {
  return a.y < b.y + b.height && b.y < a.y + a.height;
}

const TextLabel* label(const DrawList& list, const std::string& end) {
  const auto found =
      std::ranges::find_if(list.labels, [&](const TextLabel& l) { return l.text.ends_with(end); });
  return found == list.labels.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("a scale bar says for which depth it holds, but where it holds for all") {
  CHECK(label(ring("scale_bar = true\n"), " m in the middle"));
  const DrawList parallel = ring("scale_bar = true\nprojection = \"orthographic\"\n");
  CHECK_FALSE(label(parallel, " m in the middle"));
  CHECK(label(parallel, " m"));
}

TEST_CASE("loads have no colour of the rods' ramp, and a word beside it") {
  for (const Look& look : looks()) {
    const double least = told_apart(look);
    for (const char* by : {"axial_force", "speed"}) {
      INFO(look.name << ", " << by);
      const DrawList list =
          ring("look = \"" + std::string(look.name) + "\"\ncolour_by = \"" + std::string(by) + "\"\n");
      REQUIRE_FALSE(list.arrows.empty());
      const Color& color = list.arrows.front().color;
      for (int k = 0; k <= 100; ++k)
        CHECK(distance(color, *by == 's' ? sequential_color(0.01 * k) : diverging_color(0.02 * k - 1)) >=
              least);
      const TextLabel *sign = label(list, "\u2192"), *word = label(list, "load");
      REQUIRE(sign);
      REQUIRE(word);
      CHECK(distance(sign->color, color) == 0);
      const std::string unit = *by == 's' ? "(m/s)" : "unique";
      REQUIRE(label(list, unit));
      CHECK_FALSE(overlap(*word, *label(list, unit)));
    }
  }
}

TEST_CASE("cables and nets are named, and no cable looks pulled or loaded beside colours of force") {
  const std::string reflector = "structure.kind = \"mesh_reflector\"\nsolver.end_time = 2.1\n";
  for (const Look& look : looks())
    for (const char* by : {"group", "axial_force"}) {
      INFO(look.name << ", " << by);
      const DrawList list = picture(
          reflector, "look = \"" + std::string(look.name) + "\"\ncolour_by = \"" + std::string(by) + "\"\n");
      CHECK(label(list, "net"));
      CHECK(label(list, "cable"));
      const bool forces = *by == 'a';
      const Color cable = look.line_color("cable", forces);
      const auto drawn = [&](const Color& color) {
        return std::ranges::any_of(list.tubes, [&](const Tube& t) { return distance(t.color, color) == 0; });
      };
      CHECK(drawn(cable));
      CHECK(drawn(look.line_color("net", forces)));
      if (!forces) continue;
      for (const Color& other : {diverging_color(-1), diverging_color(1), look.load_color(true)})
        CHECK(distance(cable, other) >= told_apart(look));
    }
}

}  // namespace frame_overlay_test
