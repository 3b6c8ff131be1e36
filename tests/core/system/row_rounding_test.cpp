// SPDX-License-Identifier: BSD-3-Clause
// Rows of constraints that nothing is left of once linear ones are eliminated.
#include <catch2/catch.hpp>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace row_rounding_test {

using testing::number;

TEST_CASE("a line through two nodes on guides and a fixed one moves as its one freedom says") {
  // A and B slide along x, the line through them turns about C: B moves s times as far as A, by similar
  // triangles. Two of the line's three rows say that; of the third, entries that cancel are left.
  constexpr double s = 0.48, force = 4.6, mass_a = 0.75, mass_b = 0.5;
  const Vec3 c(1.2956, -0.0469, 0.1894), a(-0.9245, -0.6145, -0.6772);
  const auto node = [](const std::string& name, const Vec3& x, const std::string& rest) {
    return "[[structure.nodes]]\nname = '" + name + "'\nposition = [" + number(x[0]) + ", " + number(x[1]) +
           ", " + number(x[2]) + "]\n" + rest + "\n";
  };
  const std::string scene = "[structure]\nkind = 'custom'\n" + node("A", a, "mass = " + number(mass_a)) +
                            node("B", c + s * (a - c), "mass = " + number(mass_b)) +
                            node("C", c, "fixed = true") +
                            "[[structure.constraints]]\nkind = 'collinear'\nnodes = ['A', 'B', 'C']\n"
                            "[[structure.constraints]]\nkind = 'line'\nnodes = ['A', 'B']\n"
                            "direction = [1, 0, 0]\n[[loads]]\nnodes = ['A']\nforce = [" +
                            number(force) + ", 0, 0]\n[solver]\nend_time = 0.5\nstep = 0.01\n";
  const double way = 0.5 * force / (mass_a + s * s * mass_b) * 0.25;
  for (const char* method : {"dvm", "rk4", "generalized_alpha"})
    for (const char* eliminate : {"true", "false"}) {
      const Simulation run = testing::run_scene(scene, {std::string("solver.method=") + method,
                                                        std::string("solver.eliminate_linear=") + eliminate});
      INFO(method << ", eliminated: " << eliminate << "; " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const VectorXd q = testing::end_positions(run);
      // A constant force is exact for all of them, but for the round-off of 50 steps and what the rows allow.
      CHECK(std::abs(q[0] - a[0] - way) <= 1e-9);
      CHECK(std::abs(q[3] - (c + s * (a - c))[0] - s * way) <= 1e-9);
    }
}

}  // namespace row_rounding_test
