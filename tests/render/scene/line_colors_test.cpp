// SPDX-License-Identifier: BSD-3-Clause
// What lies between nodes and is no rod has a colour that the legend names, or that of its force.
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
#include "render/scene/rod_field.hpp"
#include "tests/support/color_distance.hpp"

using namespace unfurl;

namespace line_colors_test {

namespace {

using testing::distance;
using testing::told_apart;

const TextLabel* label(const DrawList& list, const std::string& text) {
  const auto found = std::ranges::find(list.labels, text, &TextLabel::text);
  return found == list.labels.end() ? nullptr : &*found;
}

}  // namespace

// Relative luminance and contrast as WCAG 2.1 defines them; its criterion 1.4.11 asks for 3:1 between what is
// drawn and its ground. A colour that lies between the two hues in lightness, too, has that on white; on the
// grounds of films, of which one is as dark as the other is pale, 2:1.
TEST_CASE("no force at all is told from the ground of every look") {
  const auto luminance = [](const Color& c) {
    const auto linear = [](double v) {
      return v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
  };
  const double none = luminance(diverging_color(0));
  for (const Look& look : looks())
    for (const Color& ground : {look.background_top, look.background_bottom}) {
      CAPTURE(look.name, ground.r, ground.g, ground.b);
      const double other = luminance(ground);
      CHECK((std::max(none, other) + 0.05) / (std::min(none, other) + 0.05) >= (other > 0.99 ? 3 : 2));
    }
  // Lighter towards it from both ends: shades are told in grey, too.
  for (const double side : {-1.0, 1.0})
    for (int k = 0; k < 20; ++k)
      CHECK(luminance(diverging_color(side * 0.05 * k)) > luminance(diverging_color(side * 0.05 * (k + 1))));
}

// Where their own forces colour them, what is named is what they are while they are slack.
TEST_CASE("cables and nets are named, and no slack one looks pulled or loaded beside colours of force") {
  Scene scene =
      read_scene_text("structure.kind = \"mesh_reflector\"\nsolver.end_time = 2.1\n", "reflector.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  for (const Look& look : looks())
    for (const std::string by : {"group", "stress", "axial_force"}) {
      INFO(look.name << ", " << by);
      scene.render.look = look.name, scene.render.colour_by = by;
      const DrawList list = FrameBuilder(run.trajectory, film_style(scene, run, diagnostics)).build(2.0);
      const bool own = by == "axial_force", forces = by != "group";
      const std::string slack = own ? ", slack" : "";
      REQUIRE(label(list, "net" + slack));
      REQUIRE(label(list, "cable" + slack));
      const auto color_of = [&](const char* name) {
        return own ? look.slack_color() : look.line_color(name, forces);
      };
      const Color cable = color_of("cable");
      const auto drawn = [&](const Color& color) {
        return std::ranges::any_of(list.tubes, [&](const Tube& t) { return distance(t.color, color) == 0; });
      };
      CHECK(drawn(cable));
      CHECK(drawn(color_of("net")));
      // In the legend a line each, as in the picture a net's is the thinner one, before the name.
      const auto sample = [&](const char* name) {
        const TextLabel& word = *label(list, name + slack);
        const auto found = std::ranges::find_if(list.lines, [&](const OverlayLine& line) {
          return line.x0 < word.x && line.x1 > word.x - word.height && line.y0 == line.y1 &&
                 line.y0 > word.y && line.y0 < word.y + word.height &&
                 distance(line.color, color_of(name)) == 0;
        });
        return found == list.lines.end() ? 0.0f : found->width;
      };
      CHECK(sample("net") >= 1);
      CHECK(sample("cable") > sample("net"));
      if (!forces) continue;
      for (const Color& other : {diverging_color(-1), diverging_color(1), look.load_color(true)})
        CHECK(distance(cable, other) >= told_apart(look));
      if (own) CHECK(distance(cable, diverging_color(0)) >= told_apart(look));
    }
}

// A weight on a cable, beside a cable that is slack, a spring that is pressed and one that is slack.
TEST_CASE("cables and springs have the colours of their forces where rods have, slack ones that of none") {
  const Scene scene = read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "Q", position = [1, 0, 0], fixed = true},
  {name = "E", position = [0, 0, -1], mass = 2}, {name = "F", position = [1, 0, -1], mass = 2},
  {name = "L", position = [1, 0, -2], fixed = true}]
rods = [{nodes = ["Q", "F"], mass = 1}]
[[constraints]]
kind = "cable"
nodes = ["P", "E"]
motion = "hold"
[[constraints]]
kind = "cable"
nodes = ["P", "F"]
axial_stiffness = 1e4
length = 2
[[forces]]
kind = "spring"
nodes = ["L", "F"]
stiffness = 10
free_length = 2
[[forces]]
kind = "spring"
nodes = ["L", "E"]
stiffness = 10
free_length = 3
tension_only = true
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 2
step = 0.01
end_time = 0.05
)",
                                      "hung.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics d = diagnose(run);
  FrameStyle style;
  style.options.colour_by = "axial_force";
  style.run = &run;
  style.diagnostics = &d;
  const RodField field = rod_field("axial_force", {0, 0}, run, d);
  const DrawList list = FrameBuilder(run.trajectory, style).build(0.02);
  const auto tubes_of = [&](const Color& c) {
    return std::ranges::count_if(list.tubes, [&](const Tube& tube) {
      return std::hypot(tube.color.r - c.r, tube.color.g - c.g, tube.color.b - c.b) < 0.002f;
    });
  };
  CHECK(tubes_of(field.color(2 * 9.81)) == 1);               // m g
  CHECK(tubes_of(field.color(-10)) > 1);                     // wound: k (l - l_0)
  CHECK(tubes_of(find_look("studio")->slack_color()) == 1);  // no force
  CHECK(field.high == 20);                                   // above 19.62 N
  const auto says = [&](const char* text) {
    return std::ranges::any_of(list.labels, [&](const TextLabel& l) { return l.text == text; });
  };
  CHECK(says("cable, slack"));
  CHECK_FALSE(says("cable"));
  style.options.colour_by = "speed";  // as before
  const DrawList others = FrameBuilder(run.trajectory, style).build(0.02);
  CHECK(std::ranges::any_of(others.labels, [](const TextLabel& l) { return l.text == "cable"; }));
}

// A bar of colours above the time fills the lower half of a thumbnail.
TEST_CASE("a legend that would stand in the structure's place is left out") {
  const Scene scene = read_scene_text(R"(structure.kind = 'custom'
structure.nodes = [{name="A",position=[0,0,0],fixed=true},{name="B",position=[1,0,0]},{name="C",position=[0,0,1],fixed=true}]
structure.rods = [{nodes=["A","B"],mass=1}]
forces = [{kind="cable",nodes=["C","B"],axial_stiffness=1e4,length=3}]
gravity.acceleration = [0, 0, -9.81]
deployment.measure = "1 coordinate B along 0 0 1"
deployment.deployed = -1
render.colour_by = 'axial_force'
solver.end_time = 0.1
)",
                                      "slack.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  for (const auto& [width, height] : {std::pair{640, 360}, {200, 150}}) {
    style.width = width, style.height = height;
    const DrawList list = FrameBuilder(run.trajectory, style).build(0.1);
    CHECK((label(list, "cable, slack") != nullptr) == (width == 640));
    CHECK(list.areas.size() > 60);  // the bar
  }
}

}  // namespace line_colors_test
