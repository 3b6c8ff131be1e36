// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/rod_field.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "render/scene/color_map.hpp"
#include "render/scene/frame_builder.hpp"

using namespace unfurl;

namespace rod_field_test {

namespace {

// A rod of 2 m and 3 kg that turns about its fixed end at 5 rad/s, without gravity.
const char* const spinning = R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "P"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "E"
position = [2, 0, 0]
velocity = [0, 10, 0]
[[structure.rods]]
nodes = ["P", "E"]
mass = 3.0
[solver]
stages = 4
step = 0.01
end_time = 0.5
)";

struct Run {
  Scene scene = read_scene_text(spinning, "spin.toml");
  Simulation run = simulate(build_model(scene), scene.solver);
  Diagnostics diagnostics = diagnose(run);
};

}  // namespace

TEST_CASE("a rod's speed is that of its middle") {
  const Run r;
  const RodField field = rod_field("speed", {0, 0}, r.run, r.diagnostics);
  // omega L / 2; the method keeps the energy of this motion to much better than 1e-6.
  for (const double t : {0.0, 0.123, 0.5}) CHECK(field.at(t, 0) == Approx(5.0).epsilon(1e-6));
  CHECK(field.low == 0);
  CHECK(field.high == Approx(5));  // a round number at or above all values
}

// A chain that hangs as gravity pulls, up to the digits of its positions, and would be coloured by them.
TEST_CASE("a structure at rest has no speed, and one that creeps has") {
  const std::string hangs = R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0.1, 0.2, 0.3], fixed = true}, {name = "A", position = [0.5, 0.5, -0.9]},
         {name = "B", position = [0.9, 0.8, -2.1], velocity = [0, 0, 0]}]
rods = [{nodes = ["P", "A"], mass = 1}, {nodes = ["A", "B"], mass = 2}]
[gravity]
acceleration = [4, 3, -12]
[solver]
step = 0.01
end_time = 0.5
)";
  const auto field_of = [&](const std::vector<std::string>& changes) {
    const Scene scene = read_scene_text(hangs, "hangs.toml", changes);
    const Simulation run = simulate(build_model(scene), scene.solver);
    CHECK(run.trajectory.node_velocities(run.trajectory.size() - 1).lpNorm<Eigen::Infinity>() > 0);
    return rod_field("speed", {0, 0}, run, diagnose(run));
  };
  const RodField still = field_of({}), creeps = field_of({"structure.nodes[2].velocity=[3e-9,-4e-9,0]"});
  CHECK(still.values.isZero(0));
  CHECK(still.high == 1);
  CHECK(creeps.at(0, 1) == Approx(2.5e-9).epsilon(1e-9));
}

TEST_CASE("a rod's force is the centripetal one, and tension is red") {
  const Run r;
  const RodField field = rod_field("axial_force", {0, 0}, r.run, r.diagnostics);
  // With half of the coupling mass of the consistent matrix at each end, (m/3) omega^2 L.
  CHECK(field.at(0.25, 0) == Approx(3.0 / 3 * 25 * 2).epsilon(1e-5));
  CHECK(field.diverging);
  CHECK(field.low == -field.high);
  const Color tension = field.color(field.high), compression = field.color(field.low);
  CHECK(tension.r > tension.b + 0.3f);
  CHECK(compression.b > compression.r + 0.3f);
  const Color none = field.color(0.0);
  CHECK(std::abs(none.r - none.b) < 0.02f);
}

TEST_CASE("constraint errors are at round-off and drawn on a logarithmic scale") {
  const Run r;
  const RodField field = rod_field("constraint_error", {0, 0}, r.run, r.diagnostics);
  CHECK(field.log);
  CHECK(field.at(0.5, 0) < 1e-13);
  CHECK(field.low > 0);
  CHECK(field.position(std::sqrt(field.low * field.high)) == Approx(0.5));
}

TEST_CASE("a given range is kept, beyond it the colour is that of its end, and grey where nothing is known") {
  const Run r;
  const RodField field = rod_field("speed", {1, 3}, r.run, r.diagnostics);
  CHECK(field.low == 1);
  CHECK(field.high == 3);
  CHECK(field.above);  // it moves at 5 m/s, and the bar must say that its end is not the largest value
  CHECK_FALSE(field.below);
  CHECK_FALSE(rod_field("speed", {0, 0}, r.run, r.diagnostics).above);
  CHECK(field.color(99).g == sequential_color(1).g);
  CHECK(field.color(-1).b == sequential_color(0).b);
  const Color unknown = field.color(std::nan(""));
  CHECK((unknown.r == unknown.g && unknown.g == unknown.b));
  CHECK_THROWS_AS(rod_field("mood", {0, 0}, r.run, r.diagnostics), std::invalid_argument);
}

TEST_CASE("colour maps grow lighter or run from blue to red without a jump") {
  const auto light = [](const Color& c) { return 0.21f * c.r + 0.72f * c.g + 0.07f * c.b; };
  for (int k = 0; k < 100; ++k) {
    CHECK(light(sequential_color((k + 1) / 100.0)) > light(sequential_color(k / 100.0)));
    const Color a = diverging_color(k / 50.0 - 1), b = diverging_color((k + 1) / 50.0 - 1);
    CHECK(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 0.06f);
  }
}

TEST_CASE("the picture of a run shows the field's colour, its bar and what else is asked for") {
  const Run r;
  FrameStyle style;
  style.options.colour_by = "speed";
  style.options.colour_range = {0, 10};
  style.options.inset = "kinetic_energy_J";
  style.options.method = style.options.errors = style.options.axes = style.options.scale_bar = true;
  style.options.node_labels = style.options.rod_labels = true;
  style.run = &r.run;
  style.diagnostics = &r.diagnostics;
  const FrameBuilder builder(r.run.trajectory, style);
  const DrawList list = builder.build(0.25);
  style.options.colour_range = {0, 3};
  std::string bar;
  for (const TextLabel& label : FrameBuilder(r.run.trajectory, style).build(0.25).labels)
    bar += label.text + "|";
  CHECK_THAT(bar, Catch::Contains("|\u2265 3|"));
  CHECK(list.tubes[0].color.g == Approx(sequential_color(0.5).g).margin(1e-4));
  CHECK(list.areas.size() == 64);
  std::string texts = "|";
  for (const TextLabel& label : list.labels) texts += label.text + "|";
  for (const char* text :
       {"speed (m/s)|", "dvm, s = 4, h = 0.01 s|", "so far: constraints ", "|x|", "|P|", "|E|", "P-E"})
    CHECK_THAT(texts, Catch::Contains(text));
  REQUIRE(list.inset.figure);
  CHECK(list.inset.figure->panels[0].curves[0].x.size() == 26);  // of 51 states
  style.options.inset = "no_such_column";
  CHECK_THROWS_AS(FrameBuilder(r.run.trajectory, style), std::invalid_argument);
}

TEST_CASE("ghosts are earlier poses, trails end at their node") {
  const Run r;
  FrameStyle style;
  style.options.ghosts = 4;
  DrawList list = FrameBuilder(r.run.trajectory, style).build(0.3);
  CHECK(list.ghosts.size() ==
        3);  // of the poses at 0, 1/4, 1/2 and 3/4 of the way, those before 0.3 of 0.5 s
  style.options.ghosts = 0;
  style.trails = {1};
  list = FrameBuilder(r.run.trajectory, style).build(0.3);
  REQUIRE(list.ghosts.size() > 5);
  CHECK((list.ghosts.back().b.cast<double>() - r.run.trajectory.positions_at(0.3).segment<3>(3)).norm() <
        1e-6);
  CHECK((list.ghosts.front().a - Vec3f(2, 0, 0)).norm() < 1e-6f);
}

// However long the run is: 60 s at 5 rad/s are 48 turns. The lines' middles are off the circle of 2 m by no
// more than a pixel of a picture that shows it whole.
TEST_CASE("a trail is where the node was") {
  std::string text = spinning;
  text.replace(text.find("step = 0.01"), 26, "step = 0.004\nend_time = 60");
  const Scene scene = read_scene_text(text, "spin.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  FrameStyle style;
  style.trails = {1};
  const DrawList list = FrameBuilder(run.trajectory, style).build(60);
  double way = 0;
  for (const auto& line : list.ghosts) {
    CHECK(std::abs((0.5f * (line.a + line.b)).norm() - 2) < 0.005f);
    way += static_cast<double>((line.b - line.a).norm());
  }
  CHECK(way == Approx(600).epsilon(0.005));
  CHECK(list.ghosts.size() < 48 * 80);
}

TEST_CASE("stress and buckling colour rods that have a modulus, others are grey and the legend says so") {
  std::string text = spinning;
  text.replace(text.find("mass = 3.0"), 10, "mass = 3.0\narea = 2e-4\nyoungs_modulus = 7e10");
  const Scene scene = read_scene_text(text, "spin.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics d = diagnose(run);
  const RodField stress = rod_field("stress", {0, 0}, run, d);
  CHECK(stress.at(0.25, 0) == Approx(1e-6 * 50 / 2e-4).epsilon(1e-5));
  CHECK(stress.diverging);
  CHECK(rod_field("buckling", {0, 0}, run, d).at(0.25, 0) == 0.0);  // pulled
  const Run rigid;
  const RodField unknown = rod_field("buckling", {0, 0}, rigid.run, rigid.diagnostics);
  CHECK(std::isnan(unknown.at(0.25, 0)));
  CHECK(unknown.label.find("no rod has a youngs_modulus") != std::string::npos);
}

TEST_CASE("an error of length is off the length that is asked for, and an elastic rod has none") {
  const auto field_of = [](const std::string& more) {
    std::string text = spinning;
    text.replace(text.find("mass = 3.0"), 10, "mass = 3.0\n" + more);
    const Scene scene = read_scene_text(text, "spin.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    return rod_field("constraint_error", {0, 0}, run, diagnose(run));
  };
  // It stretches by F l / E A = 50 N * 2 m / (1e7 Pa * 1e-4 m^2) = 0.1 m.
  const RodField elastic = field_of("area = 1e-4\nelastic = true\nyoungs_modulus = 1e7");
  CHECK_FALSE(elastic.known);
  CHECK(std::isnan(elastic.at(0.25, 0)));
  CHECK_THAT(elastic.label, Catch::Contains("all rods are elastic"));
  // It grows by 0.2 m as is asked for; errors are some round-offs of 2 m.
  const RodField warm = field_of(
      "[[forces]]\nkind = 'temperature'\nrods = ['P-E']\nexpansion = 1e-3\nchange = 100\ntimes = [0, 0.25, "
      "0.5]\n"
      "values = [0, 0.5, 1]\n");
  CHECK(warm.known);
  for (const double t : {0.0, 0.2, 0.5}) CHECK(warm.at(t, 0) < 1e-13);
}

TEST_CASE("what is not known has a colour that no value has, and reaches no further than its state") {
  RodField field;
  field.t = {0, 1, 2, 3};
  field.values.resize(4, 1);
  field.values << 2, 4, std::nan(""), 6;
  CHECK(field.at(1, 0) == 4);
  CHECK(field.at(1.75, 0) == 4);
  CHECK(std::isnan(field.at(2, 0)));
  CHECK(field.at(2.25, 0) == 6);
  CHECK(field.at(3, 0) == 6);
  field.low = -1, field.high = 1;
  for (const bool diverging : {false, true}) {
    field.diverging = diverging;
    const Color unknown = field.color(std::nan(""));
    for (double x = -1; x <= 1; x += 0.01) {
      const Color c = field.color(x);
      // As far apart as dark and pale grey at least: a third of the way from black to white.
      CHECK(std::hypot(c.r - unknown.r, c.g - unknown.g, c.b - unknown.b) > 0.3f);
    }
  }
}

TEST_CASE("helpers that are not shown have no part in the colours' range") {
  const Scene scene = read_scene_file(find_scene("bricard"), {"solver.end_time=1"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics d = diagnose(run);
  const std::vector<char> shown = shown_rods(run.trajectory.structure());
  double most = 0, most_hidden = 0;
  for (Index r = 0; r < d.axial_force.cols(); ++r) {
    double& of = shown[static_cast<std::size_t>(r)] ? most : most_hidden;
    of = std::max(of, d.axial_force.col(r).lpNorm<Eigen::Infinity>());
  }
  REQUIRE(most_hidden > 1.01 * most);
  const RodField field = rod_field("axial_force", {-1.001 * most, 1.001 * most}, run, d);
  CHECK(field.known);
  CHECK_FALSE(field.below);
  CHECK_FALSE(field.above);
  CHECK(rod_field("axial_force", {0, 0}, run, d).high <= 5 * most);  // the next of 1, 2, 5, 10
}

TEST_CASE("a bar of errors says so where values lie below its end") {
  const Run r;
  for (const double low : {1e-12, 1e-19}) {
    const RodField field = rod_field("constraint_error", {low, 1e-3}, r.run, r.diagnostics);
    CHECK(field.below);  // errors of 2 m are some 1e-16 m, at the start none
    CHECK_FALSE(field.above);
  }
}

TEST_CASE("the picture says that something is not known, while it is not") {
  Run r;
  r.diagnostics.axial_force(r.diagnostics.axial_force.rows() - 1, 0) = std::nan("");
  FrameStyle style;
  style.options.colour_by = "axial_force";
  style.run = &r.run;
  style.diagnostics = &r.diagnostics;
  const FrameBuilder builder(r.run.trajectory, style);
  for (const double t : {0.25, 0.499, 0.5}) {
    const DrawList list = builder.build(t);
    CHECK(std::ranges::any_of(list.labels, [](const TextLabel& l) { return l.text == "not known"; }) ==
          (t == 0.5));
  }
}

TEST_CASE("around zero the colour tells the sign, whatever the range") {
  RodField field;
  field.diverging = true;
  const auto blue = [&](double x) { return field.color(x).b - field.color(x).r; };
  for (const auto& [low, high] :
       {std::pair{0.0, 0.5}, {-1.0, 3.0}, {1234.0, 1240.0}, {-8.0, -2.0}, {-3.0, 0.0}}) {
    field.low = low, field.high = high;
    CAPTURE(low, high);
    for (double x = low; x <= high; x += (high - low) / 64) {
      if (x > 0) CHECK(blue(x) < 0.02f);
      if (x < 0) CHECK(blue(x) > -0.02f);
    }
    if (high > 0) CHECK(blue(high) < -0.3f);
    if (low < 0) CHECK(blue(low) > 0.3f);
    if (low <= 0 && high >= 0) CHECK(std::abs(blue(0)) < 0.02f);
  }
}

// The rod of `spinning`, let go and moving along itself: its force is 0, and rounding has no colour.
TEST_CASE("rods without a force are grey, whatever rounding leaves") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, 0, 0], velocity = [3, 1, 0.7]}, "
      "{name = "
      "'E', position = [2, 0.1, 0], velocity = [3, 1, 0.7]}]\nrods = [{nodes = ['P', 'E'], mass = "
      "3}]\n[solver]\n"
      "end_time = 2\n",
      "drift.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  Diagnostics d = diagnose(run);
  d.axial_force(7, 0) = 1e-27;  // whatever this run's rounding is
  const RodField field = rod_field("axial_force", {0, 0}, run, d);
  const Color grey = diverging_color(0);
  for (const double t : d.t) {
    const Color c = field.color(field.at(t, 0));
    CHECK(std::hypot(c.r - grey.r, c.g - grey.g, c.b - grey.b) == 0.0f);
  }
  CHECK(field.high == 1);  // of the bar: no number of rounding
}

}  // namespace rod_field_test
