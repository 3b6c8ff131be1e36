// SPDX-License-Identifier: BSD-3-Clause
// Friction on a distance that comes to nothing: the nodes pass each other, and it acts against that, too.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace friction_at_zero_test {

namespace {

std::string vector(const Vec3& x) {
  return "[" + testing::number(x.x()) + ", " + testing::number(x.y()) + ", " + testing::number(x.z()) + "]";
}

// 1 kg on a guide along u, from 1 m at -2 m/s towards the node A, with friction of 1 N on their distance
// under a weight g along u.
Simulation thrown(const Vec3& u, double g, double step, const std::string& method) {
  return testing::run_scene(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', "
      "position = " +
      vector(u) + ", velocity = " + vector(-2 * u) +
      ", mass = 1}]\nrods = []\nconstraints = [{kind = 'line', nodes = ['B'], direction = " + vector(u) +
      "}]\n[gravity]\nacceleration = " + vector(g * u) +
      "\n[[forces]]\nkind = 'friction'\nname = 'f'\nnodes = ['A', 'B']\nkinetic = 1\n[solver]\nmethod = '" +
      method + "'\nstages = 4\nend_time = 1.5\nstep = " + testing::number(step) + "\n");
}

}  // namespace

// Against the motion all the time, x = 1 - 2 t + (1 + g) t^2 / 2, until it rests: for g = 0.5 m/s^2 in x =
// -1/3 m at 4/3 s, where it sticks. It passes A where x = 0.
TEST_CASE("friction on a distance goes on against the motion where the distance comes to zero") {
  for (const Vec3& u : {Vec3(1, 0, 0), Vec3(0.48, 0.6, 0.64)})
    for (const double g : {0.0, -0.5, 0.5, -1.5})
      for (const double step : {0.01, 0.037})
        for (const char* method : {"dvm", "rk4_projected"}) {
          CAPTURE(u.transpose(), g, step, method);
          const Simulation run = thrown(u, g, step, method);
          REQUIRE(run.status == RunStatus::completed);
          CHECK(run.warnings.empty());
          const double a = 1 + g, t = g == 0.5 ? 4.0 / 3 : 1.5, x = 1 - 2 * t + 0.5 * a * t * t;
          const VectorXd end = testing::end_positions(run);
          CHECK(end.tail<3>().dot(u) == Approx(x).epsilon(1e-9));
          CHECK(run.trajectory.node_velocities(run.trajectory.size() - 1).tail<3>().dot(u) ==
                Approx(-2 + a * t).epsilon(0).margin(1e-9));
          const double passes = a != 0 ? (2 - std::sqrt(4 - 2 * a)) / a : 0.5;
          const auto turns =
              std::ranges::find_if(run.events, [](const Event& e) { return e.kind == "reversal"; });
          REQUIRE(turns != run.events.end());
          CHECK(turns->t == Approx(passes).epsilon(1e-9));
          CHECK(std::ranges::count_if(run.events, [](const Event& e) { return e.kind == "reversal"; }) == 1);
          const Diagnostics d = diagnose(run);
          CHECK(d.at("dissipated_J").values.back() == Approx(1 - x).epsilon(1e-9));
          CHECK(testing::largest(d, "energy_balance_J") < 1e-9);
        }
}

}  // namespace friction_at_zero_test
