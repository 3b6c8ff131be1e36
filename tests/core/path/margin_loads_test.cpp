// SPDX-License-Identifier: BSD-3-Clause
// What stops and latches bear at the end of the way, against closed forms and a run's own forces.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/path/margin.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"

using namespace unfurl;

namespace margin_loads_test {

namespace {

constexpr double deg = radians_per_degree;

Margin margin_in(const Scene& scene, const std::map<std::string, double>& factors = {}) {
  return margin_of(build_model(scene), scene.solver, factors);
}

// A bob of 1.5 kg on a rod of 0.8 m and 0.6 kg falls from level in a plane; X is 0.8 m straight below O.
constexpr double l = 0.8, bob = 1.5, rod = 0.6, g = 9.81;

Scene pendulum(const std::string& stop, const std::vector<std::string>& changes = {}) {
  return read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.8, 0, 0], mass = 1.5},
  {name = "X", position = [0, 0, -0.8], fixed = true}]
rods = [{nodes = ["O", "B"], mass = 0.6}]
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 6
step = 0.005
end_time = 3
[[constraints]]
)" + stop + "\n",
                         "pendulum.toml", changes);
}

// Fallen by that angle below level.
double torque(double fallen) {
  return (bob + rod / 2) * g * l * std::cos(fallen);
}
double energy(double fallen) {
  return (bob + rod / 2) * g * l * std::sin(fallen);
}
double rate(double fallen) {
  return std::sqrt(2 * energy(fallen) / ((bob + rod / 3) * l * l));
}

// The ring of six, as margin_test.cpp has it.
constexpr double hinge = 170, chord = 3.0, start = 74 * deg;

Scene ring(const std::vector<std::string>& more, const char* scene = "hoop6") {
  std::vector<std::string> changes{"structure.fold_angle=74", "structure.hinge_force=170", "solver.stages=5",
                                   "solver.end_time=20"};
  changes.insert(changes.end(), more.begin(), more.end());
  return read_scene_file(find_scene(scene), changes);
}

}  // namespace

TEST_CASE("a pendulum loads the stop that it falls on by its weight and meets it with its energy") {
  for (const double below : {20.0, 55.0, 80.0}) {
    const double fallen = below * deg;
    // From the rod to the vertical below: 90 degrees at the start.
    const Scene scene = pendulum(R"(kind = "angle_stop"
name = "bar"
nodes = ["X", "O", "B"]
min = )" + exact_number(90 - below));
    const Margin margin = margin_in(scene);
    REQUIRE(margin.loads.size() == 1);
    const MarginLoad& load = margin.loads[0];
    CHECK((load.name == "bar" && load.kind == "stop" && load.turns));
    // Tables and the motion are right to round-off of some ten digits.
    CHECK(load.load == Approx(torque(fallen)).epsilon(1e-9));
    CHECK(load.speed == Approx(rate(fallen)).epsilon(1e-9));
    CHECK(load.energy == Approx(energy(fallen)).epsilon(1e-9));
    // A run that rests on the stop has that as the force of its row.
    const Simulation run = simulate(build_model(scene), scene.solver);
    REQUIRE(run.status == RunStatus::completed);
    const Model& held = run.trajectory.last_model();
    const int row = held.system.constraint_row(static_cast<int>(held.structure.constraints.size()) - 1);
    REQUIRE(row >= 0);
    // The row is its length times the angle.
    const double force =
        held.system.constraint_lengths()[row] * run.trajectory.state(run.trajectory.size() - 1).lambda[row];
    CHECK(std::abs(force) == Approx(load.load).epsilon(1e-9));
  }
}

// The lowest point is as much below the stop: between poses that are looked at the bob would be through it
// and back. It bears the weight of the bob and half of the rod's.
TEST_CASE("a stop that bars the least part of the way ends it") {
  for (const double below : {1e-2, 1e-4, 1e-6, 1e-8}) {
    CAPTURE(below);
    const Scene scene = pendulum(
        "kind = \"coordinate_stop\"\nname = \"floor\"\nnodes = [\"B\"]\ndirection = [0, 0, "
        "1]\nmin = " +
        exact_number(below - l) + "\n[deployment]\nmeasure = 'angle X O B about 0 1 0'\ndeployed = 30\n");
    const Margin margin = margin_in(scene);
    REQUIRE(margin.loads.size() == 1);
    CHECK(margin.loads[0].name == "floor");
    const double fallen = std::asin(1 - below / l);
    // What is left of the stop's slope, sqrt(2 below / l), divides rounding.
    const double rounding = 1e-11 / std::sqrt(below);
    CHECK(margin.loads[0].load == Approx((bob + rod / 2) * g).epsilon(rounding));
    CHECK(margin.loads[0].speed == Approx(l * rate(fallen) * std::cos(fallen)).epsilon(rounding));
    CHECK(margin.loads[0].energy == Approx(energy(fallen)).epsilon(1e-9));
  }
}

// In a survey's coordinates: 1e5 m are known to 1e-11 m, series of poses along the way end at some twenty of
// that, their slopes and what is divided by these have as much again.
TEST_CASE("where a structure stands says nothing about its margins") {
  const std::string bar = "kind = \"angle_stop\"\nname = \"bar\"\nnodes = [\"X\", \"O\", \"B\"]\nmin = 35";
  for (const double shift : {1e3, 1e4, 1e5, 1e6}) {
    CAPTURE(shift);
    const auto at = [&](const char* node, double x, double z) {
      return std::string("structure.nodes[") + node + "].position=[" + exact_number(x + shift) + ", " +
             exact_number(2 * shift) + ", " + exact_number(z - shift) + "]";
    };
    const Margin margin = margin_in(pendulum(bar, {at("0", 0, 0), at("1", l, 0), at("2", 0, -l)}));
    REQUIRE(margin.loads.size() == 1);
    CHECK(margin.loads[0].load == Approx(torque(55 * deg)).epsilon(1e-12 * shift));
    CHECK(margin.loads[0].speed == Approx(rate(55 * deg)).epsilon(1e-12 * shift));
  }
}

TEST_CASE("a stop between two nodes bears a force and is met with the speed of their distance") {
  // |BX| = 2 l sin(phi / 2), phi the angle between both, so that d|BX| = l cos(phi / 2) dphi.
  const double phi = 25 * deg, fallen = 90 * deg - phi;
  const std::string stop = R"(kind = "length_stop"
name = "pad"
nodes = ["B", "X"]
min = )" + exact_number(2 * l * std::sin(phi / 2));
  const Margin margin = margin_in(pendulum(stop));
  REQUIRE(margin.loads.size() == 1);
  const double arm = l * std::cos(phi / 2);
  CHECK_FALSE(margin.loads[0].turns);
  CHECK(margin.loads[0].load == Approx(torque(fallen) / arm).epsilon(1e-9));
  CHECK(margin.loads[0].speed == Approx(rate(fallen) * arm).epsilon(1e-9));
  CHECK(margin.loads[0].energy == Approx(energy(fallen)).epsilon(1e-9));
  // Factors are in it: everything is twice as large, the speed by the root.
  const Margin twice = margin_in(pendulum(stop), {{"gravity", 2.0}});
  CHECK(twice.loads[0].load == Approx(2 * margin.loads[0].load).epsilon(1e-9));
  CHECK(twice.loads[0].energy == Approx(2 * margin.loads[0].energy).epsilon(1e-9));
}

TEST_CASE("a stop that the motion swings past the middle to is pulled at by nothing") {
  // 30 degrees beyond the vertical: gravity pulls back, off the stop.
  const Margin margin = margin_in(pendulum(R"(kind = "angle_stop"
nodes = ["X", "O", "B"]
axis = [0, 1, 0]
max = 30)"));
  REQUIRE(margin.loads.size() == 1);
  CHECK(margin.loads[0].load == 0);
  CHECK(margin.loads[0].energy == Approx(energy(120 * deg)).epsilon(1e-9));
}

TEST_CASE("latches bear what drives the deployed pose on, and take the energy that a run says they take") {
  const double total = 12 * hinge * chord, work = total * std::sin(start);
  for (const char* name : {"hoop6", "hoop6_sector"}) {
    INFO(name);
    const Margin margin = margin_in(ring({"solver.at_deployed=latch"}, name));
    REQUIRE(margin.loads.size() == 2);
    const MarginLoad& all = margin.loads[0];
    CHECK((all.kind == "latch" && all.turns));
    // Next to the deployed pose tangents are right to some nine digits (margin_test.cpp), and the motion's
    // place there to the root of round-off.
    CHECK(all.load == Approx(total).epsilon(1e-8));
    CHECK(all.energy == Approx(work).epsilon(1e-8));
    // Each holds a hinge level with its neighbours, l sin(fold) away, and 12 bear alike.
    const MarginLoad& each = margin.loads[1];
    CHECK((each.kind == "latch" && !each.turns));
    CHECK_THAT(each.name, Catch::Contains("12"));
    CHECK(each.load == Approx(hinge).epsilon(1e-8));
    CHECK(each.speed == Approx(all.speed * chord).epsilon(1e-8));
    CHECK(each.energy == Approx(work / 12).epsilon(1e-8));
  }
  const Scene scene = ring({"solver.at_deployed=latch"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  const auto latched = std::find_if(run.events.begin(), run.events.end(),
                                    [](const Event& event) { return event.kind == "latch"; });
  REQUIRE(latched != run.events.end());
  CHECK(latched->energy_lost == Approx(work).epsilon(1e-6));
  // Nothing latches where the scene has no latches.
  CHECK(margin_in(ring({})).loads.empty());
}

// Each holds its hinge by a length w: at rates of w r they bear w of each other's loads, and of the work that
// these do together, 12 hinge r, all do their part.
TEST_CASE("of latches that go at unlike rates the most loaded is told") {
  const Scene scene = ring({"solver.at_deployed=latch"});
  Structure structure = build_model(scene)->structure;
  double most = 0, squares = 0;
  for (std::size_t k = 0; k < structure.deployment.latches.size(); ++k) {
    const double w = (k % 2 ? -1 : 1) * (0.6 + 0.13 * static_cast<double>((5 * k) % 12));
    for (Vec3& c : structure.deployment.latches[k].coefficients) c *= w;
    most = std::max(most, std::abs(w));
    squares += w * w;
  }
  System system(structure, true);
  const Margin margin =
      margin_of(std::make_shared<const Model>(Model{structure, std::move(system)}), scene.solver, {});
  const double total = 12 * hinge * chord, work = total * std::sin(start);
  REQUIRE(margin.loads.size() == 2);
  CHECK(margin.loads[0].load == Approx(total).epsilon(1e-8));
  const MarginLoad& one = margin.loads[1];
  CHECK(one.name == "most loaded of 12 latches");
  CHECK(one.load == Approx(12 * hinge * most / squares).epsilon(1e-8));
  CHECK(one.speed == Approx(margin.loads[0].speed * chord * most).epsilon(1e-8));
  CHECK(one.energy == Approx(work * most * most / squares).epsilon(1e-8));
}

TEST_CASE("a latch that springs pull back holds them, and one that is not reached is met by nothing") {
  const double total = 12 * hinge * chord, work = total * std::sin(start);
  const auto spring = [](double k) {
    return R"(forces[0]={kind="torsion_spring",fold_angle=true,free_angle=74,stiffness=)" + exact_number(k) +
           "}";
  };
  // More than the drive's torque at the end, less than its work.
  const double k = 1.05 * total / start;
  REQUIRE(0.5 * k * start * start < work);
  const Margin held = margin_in(ring({"solver.at_deployed=latch", spring(k)}));
  REQUIRE(held.loads.size() == 2);
  CHECK(held.loads[0].load == Approx(total - k * start).epsilon(1e-7));
  CHECK(held.loads[0].energy == Approx(work - 0.5 * k * start * start).epsilon(1e-6));
  const Margin stalled = margin_in(ring({"solver.at_deployed=latch", spring(2 * k)}));
  REQUIRE(stalled.end == MarginEnd::stalls);
  CHECK(stalled.loads[0].load == Approx(total - 2 * k * start).epsilon(1e-7));
  CHECK((std::isnan(stalled.loads[0].speed) && std::isnan(stalled.loads[0].energy)));
  // A stop before the deployed pose ends the way: the latches are not met.
  const Margin stopped =
      margin_in(ring({"solver.at_deployed=latch",
                      R"(constraints=[{kind="angle_stop",name="jam",fold_angle=true,min=52}])"}));
  REQUIRE(stopped.loads.size() == 1);
  CHECK(stopped.loads[0].name == "jam");
  CHECK(stopped.loads[0].load == Approx(total * std::cos(52 * deg)).epsilon(1e-9));
  CHECK(stopped.loads[0].energy == Approx(total * (std::sin(start) - std::sin(52 * deg))).epsilon(1e-8));
}

TEST_CASE("a latch of a measured deployment bears along what is measured") {
  const Scene scene = pendulum(R"(kind = "coordinate_stop"
nodes = ["B"]
direction = [1, 0, 0]
max = 2
[deployment]
measure = "length B X"
deployed = 0.5)",
                               {"solver.at_deployed=latch"});
  const Margin margin = margin_in(scene);
  REQUIRE(margin.loads.size() == 1);
  const double phi = 2 * std::asin(0.5 / (2 * l)), arm = l * std::cos(phi / 2), fallen = 90 * deg - phi;
  CHECK((margin.loads[0].kind == "latch" && !margin.loads[0].turns));
  CHECK(margin.loads[0].load == Approx(torque(fallen) / arm).epsilon(1e-9));
  CHECK(margin.loads[0].speed == Approx(rate(fallen) * arm).epsilon(1e-9));
}

// An arm of 3 kg at its end falls through the horizontal, where m g cos(angle) by the way of sqrt(m) is most:
// at no pose that is looked at.
TEST_CASE("the most that a source drives is that of the way, between poses too") {
  const Margin margin = margin_in(read_scene_text(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1.5320888862379562, 0, 1.2855752193730785], mass = 3}]
rods = [{nodes = ["O", "A"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 1, 0]
[deployment]
measure = ["coordinate A along 0 0 1"]
deployed = -1.1
[gravity]
acceleration = [0, 0, -9.81]
)",
                                                  "arm.toml"));
  REQUIRE(margin.sources.size() == 1);
  CHECK(margin.sources[0].largest_drive == Approx(9.81 * std::sqrt(3)).epsilon(1e-12));
  CHECK(margin.sources[0].largest_resistance == 0);
  for (const MarginPoint& p : margin.points) CHECK(p.forces[0] < margin.sources[0].largest_drive);
}

}  // namespace margin_loads_test
