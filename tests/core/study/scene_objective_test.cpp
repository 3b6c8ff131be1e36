// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/scene_objective.hpp"
#include "core/study/solve_for.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "core/path/path.hpp"
#include "core/study/reference.hpp"

using namespace unfurl;

namespace {

SceneObjective objective_of(const std::string& text, const std::string& key, const std::string& measure) {
  return {{"one.toml", {}, std::make_shared<const std::string>(text), "."}, key, find_measure(measure), {}};
}

// A bob of 2 kg let go at the height of its pivot passes the bottom with 3 m g.
const std::string bob = R"(
structure.kind = "custom"
structure.nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 2}]
structure.rods = [{nodes = ["O", "B"], mass = 0}]
structure.constraints = [{kind = "plane", nodes = ["B"], normal = [0, 1, 0]}]
gravity.acceleration = [0, 0, -10]
solver = {stages = 5, step = 0.01, end_time = 1}
)";

// A square of rods with both diagonals, which swings about a corner: one of its six rods is too many.
const std::string square = R"(
structure.kind = "custom"
structure.nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [1, 0, 0]},
  {name = "Q", position = [1, 0, 1]}, {name = "R", position = [0, 0, 1]}]
structure.rods = [{nodes = ["O", "P"], mass = 1}, {nodes = ["P", "Q"], mass = 1}, {nodes = ["Q", "R"], mass = 1},
  {nodes = ["R", "O"], mass = 1}, {nodes = ["O", "Q"], mass = 1}, {nodes = ["P", "R"], mass = 1}]
structure.constraints = [{kind = "plane", nodes = ["P", "Q", "R"], normal = [0, 1, 0]}]
gravity.acceleration = [0, 0, -10]
solver = {step = 0.01, end_time = 0.1}
)";

}  // namespace

TEST_CASE("a measure is a function of a scene's key") {
  SceneObjective peak = objective_of(bob, "structure.nodes[B].mass", "peak_tension");
  for (const double mass : {0.5, 2.0, 7.0}) {
    CHECK(peak.at(mass) == Approx(30 * mass).epsilon(1e-6));  // between states: peaks to 3e-6
    CHECK(peak.warnings(mass).empty());
    CHECK(peak.unique(mass) == true);
  }
  CHECK(std::isnan(peak.at(-1)));
  CHECK_FALSE(peak.unique(-1));
  CHECK_FALSE(peak.unique(3));  // not asked for
  CHECK_FALSE(objective_of(bob, "structure.nodes[B].mass", "end_time").unique(2));
}

// Two stops at one angle are met at once, which no path describes: there is
// no value, and why is told. Of a bob of 2 kg that falls from the level to 60 degrees below it the stop takes
// 1 - 0.4^2 of 20 N m sin 60.
TEST_CASE("a parameter that a path refuses has no measure where others have one") {
  const std::string stops = R"(
structure.kind = "custom"
structure.nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 2},
  {name = "X", position = [0, 0, -1], fixed = true}]
structure.rods = [{nodes = ["O", "B"], mass = 0}]
structure.constraints = [{kind = "plane", nodes = ["B"], normal = [0, 1, 0]}]
constraints = [{kind = "angle_stop", name = "s", nodes = ["X", "O", "B"], min = 30, restitution = 0.4},
  {kind = "angle_stop", name = "t", nodes = ["X", "O", "B"], min = 20, restitution = 0.4}]
gravity.acceleration = [0, 0, -10]
solver = {step = 0.01, end_time = 1, model = "path"}
)";
  SceneObjective most = objective_of(stops, "constraints[t].min", "max:kinetic_energy_J");
  CHECK(std::isnan(most.at(30)));
  CHECK(most.why_none(30).find("two stops are met at once") != std::string::npos);
  SolveOptions options;
  options.low = 20, options.high = 30;
  options.why_none = [&](double x) { return most.why_none(x); };
  CHECK_THROWS_WITH(solve_for([&](double x) { return most.at(x); }, 15, options, {}),
                    Catch::Contains("the measure is not there at an end of --between, 30") &&
                        Catch::Contains("two stops are met at once"));
  CHECK(most.at(20) == Approx(20 * std::sin(pi / 3)).epsilon(1e-6));
  CHECK(most.why_none(20).empty());
}

TEST_CASE("why the runs of a scene have no measure is said") {
  // A crank that is to turn past what its rod reaches.
  const std::string reach = R"(
structure.kind = "custom"
structure.nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0]},
  {name = "B", position = [2, 0, 1]}, {name = "P", position = [2, 0, 0], fixed = true},
  {name = "X", position = [0, 0, 1], fixed = true}]
structure.rods = [{nodes = ["O", "A"], mass = 1}, {nodes = ["A", "B"], mass = 1}, {nodes = ["P", "B"], mass = 1}]
structure.constraints = [{kind = "plane", nodes = ["A", "B"], normal = [0, 1, 0]}]
constraints = [{kind = "angle", name = "m", nodes = ["X", "O", "A"], axis = [0, 1, 0], motion = "rate", rate = 90}]
solver = {step = 0.01, end_time = 3}
)";
  SceneObjective speed = objective_of(reach, "constraints.m.rate", "peak_speed");
  CHECK(std::isnan(speed.at(90)));
  CHECK(speed.why_none(90).find("reach") != std::string::npos);
}

TEST_CASE("a force that the model does not determine is told of the run that was asked for") {
  SceneObjective peak = objective_of(square, "gravity.acceleration[2]", "peak_rod_force");
  CHECK(peak.at(-10) > 0);
  CHECK(peak.unique(-10) == false);
}

TEST_CASE("a run's warnings are kept by the value that it was of") {
  // No double is told from its neighbour to 1e-17 of a metre.
  SceneObjective peak = objective_of(bob, "solver.tolerance", "peak_tension");
  for (const double tolerance : {1e-8, 1e-17}) CHECK(peak.at(tolerance) > 0);
  CHECK(peak.warnings(1e-8).empty());
  CHECK_FALSE(peak.warnings(1e-17).empty());
}

TEST_CASE("a run that was stopped has no value") {
  SimulationHooks hooks;
  int asked = 0;
  hooks.cancelled = [&asked] { return ++asked > 3; };
  SceneObjective peak({"one.toml", {}, std::make_shared<const std::string>(bob), "."},
                      "structure.nodes[B].mass", find_measure("peak_tension"), hooks);
  CHECK_THROWS_AS(peak.at(2), Cancelled);
}
