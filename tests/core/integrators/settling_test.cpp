// SPDX-License-Identifier: BSD-3-Clause
// What stiff dampers stop behind an event, wherever in a step that lies.
#include <catch2/catch.hpp>
#include <string>

#include "core/diagnostics/accuracy.hpp"
#include "core/integrators/settling.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace settling_test {

namespace {

// Three masses of 1 kg in line, V and U joined by a damper. W comes with 1 m/s and hands it on to U at
// 0.05 s - `before`, just before a time of the grid.
std::string blow(double before, double damping) {
  return R"([structure]
kind = "custom"
rods = []
nodes = [{name = "V", position = [0, 0, 0], mass = 1}, {name = "U", position = [1, 0, 0], mass = 1},
  {name = "W", position = [)" +
         testing::number(1.55 - before) + R"(, 0, 0], mass = 1, velocity = [-1, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["V", "U", "W"]
direction = [1, 0, 0]
[[constraints]]
kind = "length_stop"
nodes = ["U", "W"]
min = 0.5
restitution = 1
[[forces]]
kind = "spring"
nodes = ["V", "U"]
stiffness = 0
damping = )" +
         testing::number(damping) + R"(
[solver]
model = "full"
step = 0.01
end_time = 0.3
)";
}

}  // namespace

// One of them at 1 m/s, or both at 1/2: the damper takes 1/4 J. Of rates exp(-2 c t / m) nothing is left a
// quarter of a second later; at c h / m of a few its layer is resolved to 1e-4.
TEST_CASE("a stiff damper stops what an impact moves, however shortly before the end of a step") {
  for (const double damping : {270.0, 1e3, 5e4, 5e5, 4.47e6})
    for (const double before : {0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 5e-3}) {
      CAPTURE(damping, before);
      Simulation run = testing::run_scene(blow(before, damping));
      const Diagnostics d = judge(run);
      REQUIRE(run.status == RunStatus::completed);
      const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
      CHECK(v[0] == Approx(-0.5).epsilon(0).margin(1e-6));
      CHECK(v[3] == Approx(-0.5).epsilon(0).margin(1e-6));
      CHECK(d.at("dissipated_J").values.back() == Approx(0.25).epsilon(2e-3));
    }
}

// P goes at 1 m/s at once, U follows on a damper: at 1 m/s, for which the damper takes 1/2 J. By steps of a
// fixed size, and of one that an error picks.
TEST_CASE("what follows a drive's jump on a stiff damper follows it, wherever in a step that is") {
  for (const std::string& steps : {std::string("stages = 3"), std::string("adaptive = true")})
    for (const double start : {0.1, 0.0999, 0.09999, 0.099999, 0.0999999, 0.103}) {
      CAPTURE(steps, start);
      Simulation run = testing::run_scene(R"([structure]
kind = "custom"
rods = []
nodes = [{name = "P", position = [0, 0, 0], mass = 1}, {name = "U", position = [1, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["P", "U"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate"
nodes = ["P"]
direction = [1, 0, 0]
motion = "rate"
rate = 1
start = )" + testing::number(start) + R"(
[[forces]]
kind = "spring"
nodes = ["P", "U"]
stiffness = 0
damping = 1e5
[solver]
model = "full"
step = 0.01
end_time = 0.3
)" + steps + "\n");
      const Diagnostics d = judge(run);
      REQUIRE(run.status == RunStatus::completed);
      CHECK(run.trajectory.node_velocities(run.trajectory.size() - 1)[3] ==
            Approx(1).epsilon(0).margin(1e-6));
      CHECK(d.at("dissipated_J").values.back() == Approx(0.5).epsilon(2e-3));
    }
}

TEST_CASE("layers of dampers go on over the ends of steps, and nothing that is calm is asked again") {
  Settling settling;
  int asked = 0;
  const auto step = [&](double h, double rate) {
    return settling.longest_step(h, 1.0, 3, [&] { return ++asked, rate * h; });
  };
  CHECK(step(1e-3, 1e3) == 0.5e-3);  // h c / m = 1 of what is left of a step, 1000 of a whole one
  double t = 0.5e-3, longest = 0.6e-3;
  while (t < 20) {
    const double h = step(1.0, 1e3);
    CHECK(h <= 2.0001 * longest);
    longest = std::max(h, longest);
    t += h;
  }
  CHECK(longest == 1.0);
  CHECK(asked == 1);
  settling.restart();
  CHECK(step(0.01, 1.4) == 0.01);
  CHECK(step(1.0, 1.4) == 1.0);
  CHECK(asked == 2);
}

}  // namespace settling_test
