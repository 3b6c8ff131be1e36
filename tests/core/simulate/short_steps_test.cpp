// SPDX-License-Identifier: BSD-3-Clause
// Dry friction and stops in steps so short that what counts as zero of a length is far from nothing as a rate
// or as an acceleration: 1e-11 m are 1e-4 m/s and 1e3 m/s^2 in a step of 0.1 us.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace short_steps_test {

namespace {

using testing::number, testing::run_scene;

constexpr double steps[] = {1e-4, 1e-6, 1e-7};

// 2 kg along a line.
const std::string block = R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], mass = 0.75}, {name = "Q", position = [1, 0, 0], mass = 0.75}]
rods = [{nodes = ["P", "Q"], mass = 0.5}]
[[constraints]]
kind = "line"
nodes = ["P", "Q"]
direction = [1, 0, 0]
)";
const std::string rub = R"(
[[forces]]
kind = "friction"
name = "rub"
nodes = ["P"]
direction = [1, 0, 0]
kinetic = 4
static = 5
)";

std::vector<std::string> in_steps(double step, int count, std::vector<std::string> changes = {}) {
  changes.push_back("solver.step=" + number(step));
  changes.push_back("solver.end_time=" + number(count * step));
  return changes;
}

// Where the first node (`axis` of it) is at the end of a run, and how fast.
std::pair<double, double> end_of(const Simulation& run, Index at) {
  const std::size_t last = run.trajectory.size() - 1;
  return {run.trajectory.node_positions(last)[at], run.trajectory.node_velocities(last)[at]};
}

// Rounding of a metre in a step, a few times.
double rounding(double step) {
  return 2e-15 / step;
}

}  // namespace

TEST_CASE("friction that cannot hold slips the way it is pulled, in whatever steps") {
  for (const double step : steps)
    for (const int sense : {1, -1}) {
      INFO(step << ", " << sense);
      const Simulation run = run_scene(
          block + rub,
          in_steps(step, 200, {"loads[0]={nodes=[\"P\"],force=[" + number(5.5 * sense) + ",0,0]}"}));
      const double t = 200 * step;
      CHECK(run.events.empty());
      const auto [x, v] = end_of(run, 0);
      // (5.5 N - 4 N) / 2 kg.
      CHECK(std::abs(v - sense * 0.75 * t) <= rounding(step));
      CHECK(std::abs(x - sense * 0.375 * t * t) <= rounding(step) * t);
    }
}

TEST_CASE("friction lets go the way it is pulled when a growing pull gets through, in whatever steps") {
  for (const double step : steps)
    for (const int sense : {1, -1}) {
      INFO(step << ", " << sense);
      const double free = 50.3 * step, end = 100 * step;
      const Simulation run =
          run_scene(block + rub, in_steps(step, 100,
                                          {"forces[1]={kind=\"load_over_time\",nodes=[\"P\"],force=[" +
                                           number(sense) + ",0,0],times=[0," + number(2 * end) +
                                           "],values=[0," + number(5 * 2 * end / free) + "]}"}));
      REQUIRE(run.events.size() == 1);
      CHECK(run.events[0].name == "rub slips");
      // A margin is used up to 1e-10 of the force.
      CHECK(std::abs(run.events[0].t - free) <= 1e-9 * free);
      const double impulse = 2.5 * (end * end - free * free) / free - 4 * (end - free);
      CHECK(std::abs(end_of(run, 0).second - sense * impulse / 2) <= rounding(step));
    }
}

TEST_CASE("a hinge with friction turns the way it is pulled, in whatever steps") {
  const std::string hinge = R"(
[structure]
kind = "custom"
nodes = [{name = "X", position = [0, 0, 1], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1, 0, 0]}]
rods = [{nodes = ["O", "A"], mass = 3}]
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 1, 0]
[[forces]]
kind = "friction"
nodes = ["X", "O", "A"]
axis = [0, 1, 0]
kinetic = 4
static = 5
)";
  for (const double step : {1e-5, 1e-6})
    for (const int sense : {1, -1}) {
      INFO(step << ", " << sense);
      const Simulation run = run_scene(
          hinge, in_steps(step, 200, {"loads[0]={nodes=[\"A\"],force=[0,0," + number(5.5 * sense) + "]}"}));
      CHECK(run.events.empty());
      // 1 kg m^2 by 1.5 N m, of which the turned arm takes 1e-11 of 1e-3.
      CHECK(std::abs(end_of(run, 8).second - sense * 1.5 * 200 * step) <= rounding(step) + 1e-11);
    }
}

TEST_CASE("friction comes to rest when what slips has stopped, in whatever steps") {
  for (const double step : {1e-5, 1e-6, 1e-7}) {
    INFO(step);
    const double speed = 2 * 150.3 * step;  // 4 N on 2 kg
    const std::string v = "velocity=[" + number(speed) + ",0,0]";
    const Simulation run = run_scene(
        block + rub, in_steps(step, 200,
                              {"structure.nodes[0]={name=\"P\",position=[0,0,0],mass=0.75," + v + "}",
                               "structure.nodes[1]={name=\"Q\",position=[1,0,0],mass=0.75," + v + "}"}));
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].kind == "stick");
    // It is seen to have stopped where it has come back by 1e-13 m in a step: 5 steps of 0.1 us, none of 1
    // us.
    const double late = 1e-13 / step / 2;
    CHECK(std::abs(run.events[0].t - speed / 2) <= (late > step ? late : rounding(step)));
    CHECK(std::abs(end_of(run, 0).first - speed * speed / 4) <= late * late + rounding(step) * 200 * step);
  }
}

TEST_CASE("what creeps with friction goes on until that has stopped it") {
  // 5 um/s, of which 9.5 uN on 2 kg take half in half a second.
  const std::string v = "velocity=[5e-6,0,0]";
  const double step = 1e-6, t = 1000 * step;
  const Simulation run =
      run_scene(block + rub, in_steps(step, 1000,
                                      {"structure.nodes[0]={name=\"P\",position=[0,0,0],mass=0.75," + v + "}",
                                       "structure.nodes[1]={name=\"Q\",position=[1,0,0],mass=0.75," + v + "}",
                                       "forces[0].kinetic=4e-6", "forces[0].static=5e-6",
                                       "loads[0]={nodes=[\"P\"],force=[-5.5e-6,0,0]}"}));
  CHECK(run.events.empty());
  CHECK(std::abs(end_of(run, 0).second - (5e-6 - 4.75e-6 * t)) <= 0.1 * 4.75e-6 * t);
}

TEST_CASE("what leaves a stop slowly flies until it falls back") {
  // 5 um/s against 10 um/s^2: a second.
  const std::string v = "velocity=[5e-6,0,0]";
  const double step = 1e-6, t = 500 * step;
  const Simulation run =
      run_scene(block + R"(
[[constraints]]
kind = "coordinate_stop"
nodes = ["P"]
direction = [1, 0, 0]
min = 0
[gravity]
acceleration = [-1e-5, 0, 0]
)",
                in_steps(step, 500,
                         {"structure.nodes[0]={name=\"P\",position=[0,0,0],mass=0.75," + v + "}",
                          "structure.nodes[1]={name=\"Q\",position=[1,0,0],mass=0.75," + v + "}"}));
  CHECK(run.events.empty());
  CHECK(std::abs(end_of(run, 0).first - (5e-6 * t - 5e-6 * t * t)) <= rounding(step) * t);
}

}  // namespace short_steps_test
