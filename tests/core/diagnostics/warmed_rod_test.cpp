// SPDX-License-Identifier: BSD-3-Clause
// A rigid rod that grows by a third as it warms: its length and force against Newton's law.
#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace warmed_rod_test {

// 1.7 kg below a rod of 0.8 m: z = -l (1 + e), so that T = m (g - l e'').
TEST_CASE("a rod that warms lets its load down, and carries its weight and its acceleration") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [0, 0, -0.8], mass = 1.7}]
rods = [{name = "rod", nodes = ["O", "A"], mass = 0}]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [0, 0, 1]
[[forces]]
kind = "temperature"
rods = ["rod"]
expansion = 0.02
change = 10
times = [0, 0.6, 1.1, 2]
values = [0, 0.4, 1.3, 1.7]
[solver]
stages = 4
step = 0.01
end_time = 1.8
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const TimeFunction warmth = make_spline({0, 0.6, 1.1, 2}, {0, 0.4, 1.3, 1.7});
  const Diagnostics d = diagnose(run);
  for (std::size_t i = 1; i < run.trajectory.size(); ++i) {
    const double t = run.trajectory.time(i), e = 0.2 * warmth(t);
    CHECK(run.trajectory.positions(i)[5] == Approx(-0.8 * (1 + e)).epsilon(1e-12));
    // e'' has corners at the knots, where steps end: what follows from the state is right to round-off.
    CHECK(d.axial_force(static_cast<Index>(i), 0) ==
          Approx(1.7 * (9.81 - 0.8 * 0.2 * warmth.derivative(2, t))).epsilon(1e-9));
  }
}

}  // namespace warmed_rod_test
