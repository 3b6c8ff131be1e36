// SPDX-License-Identifier: BSD-3-Clause
// Forces where drives rest in a flat pose that is not the deployed one, or next to one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/singular_poses.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace rest_in_flat_pose_test {

namespace {

using testing::number;
using testing::run_scene;

// Two legs and a coupler of 1 m and 1 kg on pivots in one line, led from 60 degrees to `rest` [degrees] in
// 0.7 s, with `nodes` and `rods` beside them.
std::string linkage(double rest, const std::string& nodes = "", const std::string& rods = "") {
  return R"toml(
[structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = ["=cos(60*deg)", 0, "=sin(60*deg)"]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)"]})toml" +
         nodes + R"(]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1})" +
         rods + R"(]
[[structure.constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "angle"
name = "m"
nodes = ["X", "A0", "B0"]
axis = [0, -1, 0]
motion = "smooth"
duration = 0.7
to = )" + number(rest) +
         R"(
[solver]
step = 0.01
stages = 4
end_time = 0.9
)";
}

std::string undetermined(const Simulation& run, const Diagnostics& d) {
  for (const std::string& words : accuracy_warnings(run, d))
    if (words.find("rounding says its forces") != words.npos) return words;
  return "";
}

const std::string swinging = R"(, {name = "S", position = [0, 0, 5], fixed = true},
  {name = "Q", position = [1, 0, 5], mass = 1})",
                  string = R"(, {name = "string", nodes = ["S", "Q"], mass = 0})";

}  // namespace

// By virtual work the drive holds the weights at the ends of their arms, g (1/2 + 1/2 + 1) cos(angle): legs
// by their middles, the coupler by its ends. Towards the flat pose the second leg's force has no bound, and
// in it the equations say nothing of it, be it with a pendulum beside that moves on.
TEST_CASE("a drive that rests in a flat pose has no unique torque and rods no unique forces") {
  for (const bool beside : {false, true}) {
    Simulation run = run_scene(beside ? linkage(0, swinging, string) : linkage(0), {"solver.end_time=0.9"});
    CAPTURE(beside, run.message);
    REQUIRE(run.status == RunStatus::completed);
    record_singular_poses(run);
    const Diagnostics d = diagnose(run);
    const std::vector<double>&torque = d.at("m.torque_N_m").values, &unique = d.at("m.torque_unique").values;
    std::size_t told = 0;
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      CAPTURE(d.t[i]);
      if (d.t[i] < 0.6) CHECK(unique[i] == 1);
      // Whatever is told as unique at rest is right.
      if (d.t[i] < 0.705 || unique[i] == 0) continue;
      ++told;
      CHECK(torque[i] == Approx(2 * 9.81).epsilon(1e-4));
    }
    CHECK(told == 0);
    for (Index r = 0; r < 3; ++r) CHECK_FALSE(d.force_unique(std::ssize(d.t) - 1, r));
    if (beside) CHECK(d.force_unique(std::ssize(d.t) - 1, 3));  // the pendulum's string
    CHECK(std::ranges::any_of(accuracy_warnings(run, d), [](const std::string& words) {
      return words.find("grow without bound towards the pose at t = 0.7 s") != words.npos;
    }));
  }
}

// At x = 0.1 degrees the forces have 1e-16 / x^3 of rounding, 2e-8: they are known.
TEST_CASE("next to a flat pose a drive at rest has the torque of virtual work") {
  for (const double degrees : {0.1, 1.0}) {
    Simulation run = run_scene(linkage(degrees));
    REQUIRE(run.status == RunStatus::completed);
    record_singular_poses(run);
    const Diagnostics d = diagnose(run);
    CAPTURE(degrees, run.message);
    CHECK(d.at("m.torque_unique").values.back() == 1);
    CHECK(d.at("m.torque_N_m").values.back() ==
          Approx(2 * 9.81 * std::cos(degrees * radians_per_degree)).epsilon(1e-5));
    for (Index r = 0; r < 3; ++r) CHECK(d.force_unique(std::ssize(d.t) - 1, r));
    CHECK(undetermined(run, d).empty());
  }
}

// A held crank O-A and two pairs of rods: A-B0-F0, and B0-B1-F1, of which B1 stands `off` the line from B0 to
// F1. Statics of B1, with half of its rods' weights at it (there is no gravity), say what its two rods pull
// with, known as well as the digits of its position say its angle: 1e-16 m / off.
TEST_CASE("what rests next to a singular pose has the forces that statics says") {
  const Vec3 F1(0.53237128, 0, -1.45102643), B0(0.49654751953623820, 0, 1.73130699188689090);
  const Vec3 along = (B0 - F1).normalized(), across(-along[2], 0, along[0]);
  for (const double off : {1e-3, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8}) {
    const Vec3 B1 = F1 + 2.298 * along + off * across;
    const auto run = run_scene(R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "X", position = [3.5, 0, 0], fixed = true},
  {name = "F0", position = [-0.16161365349214307, 0, -0.6722391549860158], fixed = true},
  {name = "F1", position = [0.53237128, 0, -1.45102643], fixed = true},
  {name = "A", position = [-0.2130656636270988, 0, 1.1410216818981243]},
  {name = "B0", position = [0.49654751953623820, 0, 1.73130699188689090], mass = 0.3},
  {name = "B1", position = [)toml" +
                               number(B1[0]) + ", 0, " + number(B1[2]) + R"toml(], mass = 3.8},
  {name = "Z", position = [7, 0, 7], mass = 1}]
rods = [{nodes = ["O", "A"], mass = 1.1}, {nodes = ["A", "B0"], mass = 7.3}, {nodes = ["F0", "B0"], mass = 0.2},
  {nodes = ["B0", "B1"], mass = 0.4}, {nodes = ["F1", "B1"], mass = 0.1}]
[gravity]
acceleration = [0, 0, 0]
[[constraints]]
kind = "plane"
nodes = ["*"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
nodes = ["X", "O", "A"]
axis = [0, -1, 0]
[[loads]]
nodes = ["A", "B0", "B1"]
force = [0, 0, -40]
[solver]
step = 0.01
stages = 4
end_time = 0.1
)toml");
    INFO(off);
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const Vec3 down = (F1 - B1).normalized(), up = (B0 - B1).normalized();
    const double turn = up[0] * down[2] - up[2] * down[0];  // 40 N are up * B0-B1 + down * F1-B1
    for (const Index i : {Index{2}, Index{5}, Index{9}}) {
      CHECK(d.axial_force(i, 3) == Approx(-40 * down[0] / turn).epsilon(1e-15 / off + 1e-9));
      CHECK(d.axial_force(i, 4) == Approx(40 * up[0] / turn).epsilon(1e-15 / off + 1e-9));
    }
  }
}

}  // namespace rest_in_flat_pose_test
