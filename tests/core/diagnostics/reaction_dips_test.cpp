// SPDX-License-Identifier: BSD-3-Clause
// The size of a reaction that passes nothing within a step.
#include <catch2/catch.hpp>
#include <string>

#include "core/diagnostics/peaks.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace reaction_dips_test {

// A mass of 1 kg in its guide under a weight of 1 N, held by a drive: it bears 1 N, and 0.2 N as long as a
// load takes 0.8 N of it. From `start` on it is driven the other way, at up to -0.15 / ramp m/s^2 within
// `ramp`: its reaction goes from 1 N through nothing and back, within two steps of which no state tells. The
// corner is found to 4^-6 of the eighth of a step over which it changes by 8 N: some 1e-3 N at most.
TEST_CASE("a reaction that passes nothing behind the start of a drive has nothing as its least") {
  for (const double start : {0.2, 1.234, 3.0})
    for (const double ramp : {0.02, 0.013}) {
      CAPTURE(start, ramp);
      const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "B", position = [0, 0, 0], mass = 1}]
rods = []
constraints = [{kind = "line", nodes = ["B"], direction = [1, 0, 0]}]
[gravity]
acceleration = [-1, 0, 0]
[[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0.8, 0, 0]
times = [0, 0.1, 0.1, 9]
values = [1, 1, 0, 0]
[[constraints]]
kind = "coordinate"
nodes = ["B"]
direction = [1, 0, 0]
motion = "rate"
rate = -0.1
ramp = )" + testing::number(ramp) +
                                                "\nstart = " + testing::number(start) + R"(
[solver]
stages = 4
step = 0.01
end_time = 4
)");
      REQUIRE(run.status == RunStatus::completed);
      const Diagnostics d = diagnose(run);
      CHECK(largest_of_column(run, d, "B.reaction_x_N") == Approx(1).epsilon(1e-9));
      CHECK(smallest_of_column(run, d, "B.reaction_x_N") < -5);
      CHECK(smallest_of_column(run, d, "B.reaction_N") < 1e-3);
      CHECK(smallest_of_column(run, d, "B.reaction_N") >= 0);
    }
}

}  // namespace reaction_dips_test
