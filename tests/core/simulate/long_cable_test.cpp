// SPDX-License-Identifier: BSD-3-Clause
// A rigid cable over many nodes: its length is a sum of many, and known to what rounding leaves of that.
#include <catch2/catch.hpp>
#include <vector>

#include "core/scene/library.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace long_cable_test {

// Sixty metres over 24 diagonals are known to 7e-15 m a digit, thirty times what is round-off for a rod.
// Asked for that, the iteration went on at random, up to 60 times a step, and failed at t = 0.58 s; that of
// twelve bays took twelve.
TEST_CASE("a ring that one cable of sixty metres draws open asks for no digits that its length has not") {
  const Scene scene =
      read_scene_file(find_scene("cable_ring"), {"structure.units=24", "solver.end_time=0.7"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CAPTURE(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const std::vector<double>& iterations = d.at("newton_iterations").values;
  double all = 0;
  for (const double of_step : iterations) all += of_step;
  // Where rods turn this far in a step some five reach round-off, redundant gears ask for as many more.
  CHECK(all < 12 * static_cast<double>(iterations.size()));
  // The row's error beside what it is the sum of: some roundings of 60 m, of 1.1e-16 each.
  CHECK(testing::largest(d, "constraint_relative_max") < 1e-14);
}

}  // namespace long_cable_test
