// SPDX-License-Identifier: BSD-3-Clause
// A latch closes while something rests on a stop: the stop pushes, and does not hold, then and later.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace latch_beside_stop_test {

using testing::end_positions, testing::largest, testing::run_scene;

namespace {

// A slides to its latch at 0.5 s. B, 2 kg, rests on the floor under 20 N and is lifted by 40 N from 1 s on.
const std::string beside = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 1},
  {name = "B", position = [0, 3, 0], mass = 2}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[structure.constraints]]
kind = "line"
nodes = ["B"]
direction = [0, 0, 1]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["B"]
direction = [0, 0, 1]
min = 0
[[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0, 0, 40]
times = [0, 1, 1, 3]
values = [0, 0, 1, 1]
[gravity]
acceleration = [0, 0, -10]
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 0.5
[solver]
stages = 4
end_time = 2
at_deployed = "latch"
)";

// A slides along x to its latch, and B beside it on the floor: x_A - x_B + z_B stays 0.
const std::string thrown = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 1},
  {name = "B", position = [0, 3, 0], velocity = [1, 0, 0], mass = 2}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[structure.constraints]]
kind = "relation"
nodes = ["A", "B"]
coefficients = [1, 0, 0, -1, 0, 1]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["B"]
direction = [0, 0, 1]
min = 0
[gravity]
acceleration = [0, 0, -10]
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 0.5
[solver]
stages = 4
end_time = 0.55
at_deployed = "latch"
)";

}  // namespace

TEST_CASE("what rests on a stop while a latch closes leaves it when it is lifted") {
  const Simulation run = run_scene(beside);
  REQUIRE(run.status == RunStatus::completed);
  // (40 - 20) N / 2 kg = 10 m/s^2 for a second; parabolas are exact but for the rounding of 200 steps.
  CHECK(std::abs(end_positions(run)[5] - 5.0) <= 1e-11);
  CHECK(std::abs(end_positions(run)[0] - 0.5) <= 1e-11);
  CHECK(largest(diagnose(run), "energy_balance_J") <= 1e-10);
}

TEST_CASE("a latch throws what rests on a stop off it where the stop would have to pull") {
  // x_A - x_B + z_B stays 0: while B lies on the floor both slide at 1 m/s. A stops; B's impulse (P, -P)
  // along (x, z) leaves v = (1, 0) - (1, -1) / 2 = (1/2, 1/2): it is thrown up and flies with x_B - z_B
  // fixed, at -10 / 2 along both: z = t / 2 - 5 t^2 / 2 for 0.05 s.
  const Simulation run = run_scene(thrown);
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd x = end_positions(run);
  CHECK(std::abs(x[5] - (0.5 * 0.05 - 2.5 * 0.05 * 0.05)) <= 1e-11);
  CHECK(std::abs(x[0] - 0.5) <= 1e-11);
  REQUIRE(run.events.back().kind == "latch");
  CHECK(std::abs(run.events.back().energy_lost - (0.5 * 3 - 0.5 * 2 * 0.5)) <= 1e-10);
  CHECK(largest(diagnose(run), "energy_balance_J") <= 1e-10);
}

TEST_CASE("what a latch presses on a stop stays on it and is booked as taken by the latch") {
  // With x_A - x_B - z_B = 0 B would be thrown into the floor at 1/2 m/s. It lies there: nothing is
  // approached before, so that nothing is thrown back, and all of 3/2 J goes, by the impulse of the latch at
  // 1 m/s.
  const Simulation run = run_scene(thrown, {"structure.constraints[2].coefficients=[1, 0, 0, -1, 0, -1]",
                                            "constraints[0].restitution=0.5"});
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd x = end_positions(run);
  CHECK(std::abs(x[5]) <= 1e-12);
  CHECK(std::abs(x[3] - 0.5) <= 1e-11);
  REQUIRE(run.events.back().kind == "latch");
  CHECK(std::abs(run.events.back().energy_lost - 1.5) <= 1e-10);
}

}  // namespace latch_beside_stop_test
