// SPDX-License-Identifier: BSD-3-Clause
// Angles that turn by a good part of a rad per step where steps are solved with care for weak modes.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace far_turns_test {

namespace {

// Cranks of 1 m beside a truss that is nearly flat, which asks for care.
std::string beside_flat_truss(const std::string& nodes, const std::string& more) {
  return R"([structure]
kind = 'custom'
nodes = [{name = 'P', position = [0, 0, 5], fixed = true}, {name = 'Q', position = [2, 0, 5], fixed = true},
 {name = 'R', position = [1, 0, '=5+1e-5'], mass = 1}, {name = 'O', position = [0, 0, 0], fixed = true},
 {name = 'X', position = [1, 0, 0], fixed = true}, )" +
         nodes + R"(]
rods = [{nodes = ['P', 'R'], mass = 0}, {nodes = ['Q', 'R'], mass = 0}, {nodes = ['O', 'A'], mass = 0})" +
         more + R"(
[solver]
step = 0.01
end_time = 20
)";
}

Vec3 end_of(const Simulation& run, Index node) {
  REQUIRE(run.status == RunStatus::completed);
  return end_positions(run).segment<3>(3 * node);
}

constexpr Index A = 5, B = 7;

// Of a crank about the node at `center`, to a turn.
double angle_of(const Vec3& end, double center = 0) {
  return std::atan2(end[2] - center, end[0]);
}

// Some 2000 steps of up to 0.6 rad, each solved to 1e-14 of its motion: 1e-11 of the 700 rad and less,
// and 1e-12 of rounding coordinates of 5 m that often. Three points missed 1e-4 and more.
constexpr double rounding = 3e-11;

void none_of(double angle) {
  INFO("off by " << std::remainder(angle, 2 * pi) << " rad");
  CHECK(std::abs(std::remainder(angle, 2 * pi)) <= rounding);
}

}  // namespace

TEST_CASE("a crank that is driven far in each step beside a nearly flat truss is where its drive has it") {
  const Simulation run = run_scene(beside_flat_truss("{name = 'A', position = [1, 0, 0], mass = 1e-3}", R"(]
[[constraints]]
kind = 'plane'
nodes = ['A', 'R']
normal = [0, 1, 0]
[[constraints]]
kind = 'angle'
nodes = ['X', 'O', 'A']
axis = [0, -1, 0]
motion = 'rate'
rate = 2000)"));
  none_of(angle_of(end_of(run, A)) - 2000 * 20 * pi / 180);
}

TEST_CASE("gears and racks that turn far in each step beside a nearly flat truss do not slip") {
  const std::string cranks =
      "{name = 'A', position = [1, 0, 0], mass = 1, velocity = [0, 0, 30]}, {name = 'C', position = [0, 0, "
      "3], fixed = true}, ";
  const std::string plane = "[[constraints]]\nkind = 'plane'\nnodes = ['A', 'B', 'R']\nnormal = [0, 1, 0]\n";
  const Simulation gears = run_scene(
      beside_flat_truss(cranks + "{name = 'B', position = [1, 0, 3], mass = 1, velocity = [0, 0, -60]}",
                        ", {nodes = ['C', 'B'], mass = 0}]\n" + plane + R"([[constraints]]
kind = 'gear'
nodes = ['X', 'O', 'A', 'P', 'C', 'B']
radii = [2, 1]
axis = [0, -1, 0])"));
  none_of(2 * angle_of(end_of(gears, A)) + angle_of(end_of(gears, B), 3));
  const Simulation rack = run_scene(
      beside_flat_truss(cranks + "{name = 'B', position = [1, 0, 3], mass = 1, velocity = [30, 0, 0]}",
                        "]\n" + plane + R"([[constraints]]
kind = 'rack'
nodes = ['X', 'O', 'A', 'B']
radius = 1
axis = [0, -1, 0]
direction = [1, 0, 0]
[[constraints]]
kind = 'line'
nodes = ['B']
direction = [1, 0, 0])"));
  none_of(end_of(rack, B)[0] - 1 - angle_of(end_of(rack, A)));
}

}  // namespace far_turns_test
