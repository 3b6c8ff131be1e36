// SPDX-License-Identifier: BSD-3-Clause
// Rows that no rod has take their size from their own nodes: what else a structure has must not matter.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace own_lengths_test {

namespace {

// A quad of rods of some 10 m that stays in one plane, beside `count` rods of 1 mm that nothing joins to it.
std::string quad(int count, const std::string& kind) {
  return R"([structure]
kind = "custom"
[[structure.nodes]]
name = "A"
position = [3.3, 1.7, 0.9]
fixed = true
[[structure.nodes]]
name = "B"
position = [10, 0, 0]
velocity = [0, 1, 0]
mass = 1
[[structure.nodes]]
name = "C"
position = )" +
         std::string(kind == "coplanar" ? "[9.1, 11.3, 2.4]" : "[16.7, -1.7, -0.9]") + R"(
velocity = [0, 0, 3]
mass = 1
[[structure.nodes]]
name = "D"
position = [2.825, 11.785, 3.015]
velocity = [0, 0, 1]
mass = 1
[[structure.nodes]]
repeat = {i = "0:)" +
         std::to_string(count) + R"("}
name = "P{i}"
position = ["=20+i*2e-3", 0, 0]
mass = 1
[[structure.nodes]]
repeat = {i = "0:)" +
         std::to_string(count) + R"("}
name = "Q{i}"
position = ["=20+i*2e-3", 1e-3, 0]
velocity = [1e-3, 0, 0]
mass = 1
[[structure.rods]]
nodes = ["A", "B"]
mass = 1
[[structure.rods]]
nodes = ["B", "C"]
mass = 1
[[structure.rods]]
nodes = ["C", "D"]
mass = 1
[[structure.rods]]
repeat = {i = "0:)" +
         std::to_string(count) + R"("}
nodes = ["P{i}", "Q{i}"]
mass = 1
[[constraints]]
kind = ")" +
         kind + "\"\nnodes = [\"A\", \"B\", \"C\"" + (kind == "coplanar" ? ", \"D\"" : "") + R"(]
[solver]
end_time = 0.1
step = 0.02
)";
}

// A crank of this length at 10 m from the origin, driven, with rods of 3 m and 10 m.
std::string crank(double length) {
  return "[variables]\nt = " + testing::number(length) + R"~(
[structure]
kind = "custom"
nodes = [{name = "A", position = [10, 3.3, 0.7], fixed = true},
  {name = "B", position = ["=10+t*cos(0.3)", "=3.3+t*sin(0.3)", 0.7], mass = 1},
  {name = "Z", position = [20, 3.3, 0.7], fixed = true}, {name = "C", position = [7, 3.8, 0.7], mass = 1},
  {name = "D", position = [7, 3.8, -9.3], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1}, {nodes = ["C", "D"], mass = 1},
  {nodes = ["A", "Z"], mass = 1}]
[[constraints]]
kind = "angle"
nodes = ["Z", "A", "B"]
axis = [0, 0, 1]
motion = "rate"
rate = 90
ramp = 0.5
[[constraints]]
kind = "plane"
nodes = ["B", "C"]
normal = [0, 0, 1]
[solver]
end_time = 0.4
step = 0.02
)~";
}

}  // namespace

// Phi had been in edges of the mean rod: rounding of 10 m was 1e8 times what rows of 1 mm may leave, and no
// iteration ended. The same iterations, but for what rounding decides: a quarter.
TEST_CASE("what small rods stand beside does not change how a large plane or line is solved") {
  for (const char* kind : {"coplanar", "collinear"}) {
    INFO(kind);
    const Simulation alone = testing::run_scene(quad(1, kind)), beside = testing::run_scene(quad(300, kind));
    INFO(beside.message);
    REQUIRE(alone.status == RunStatus::completed);
    REQUIRE(beside.status == RunStatus::completed);
    CHECK(4 * beside.newton_iterations <= 5 * alone.newton_iterations);
  }
}

// Rounding 10 m is 1e-13 of the angle of a crank of 1 cm, of 1 mm ten times that: rows of the mean rod of 6 m
// had shown it in metres.
TEST_CASE("the row of a small crank far out is solved as that of a large one") {
  const long wanted = testing::run_scene(crank(10)).newton_iterations;
  for (const double length : {0.1, 0.01, 1e-3}) {
    INFO("crank of " << length << " m");
    const Simulation run = testing::run_scene(crank(length));
    REQUIRE(run.status == RunStatus::completed);
    CHECK(2 * run.newton_iterations <= 3 * wanted);
    const Simulation projected =
        testing::run_scene(crank(length), {"solver.method=rk4_projected", "solver.end_time=0.1"});
    CHECK(projected.status == RunStatus::completed);
  }
}

}  // namespace own_lengths_test
