// SPDX-License-Identifier: BSD-3-Clause
// What rests on two stops that the digits of the scene put beside each other.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace digits_of_rest_test {

namespace {

using testing::end_positions, testing::number, testing::run_scene;

}  // namespace

// A rod 1 m long at 60 deg lies on a floor under its end and on an end stop of its hinge; the floor is higher
// by `off`, by which one of both must be passed.
TEST_CASE("a body that begins on a floor and on an end stop beside it, by the digits of the scene, rests") {
  const double height = std::sqrt(0.75);
  for (const double off : {0.0, 1.2e-10, 6e-10})
    for (const char* method : {"dvm", "rk4_projected", "generalized_alpha"}) {
      const Simulation run = run_scene(
          "[structure]\nkind = 'custom'\n"
          "[[structure.nodes]]\nname = 'G'\nposition = [-1, 0, 0]\nfixed = true\n"
          "[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
          "[[structure.nodes]]\nname = 'A'\nposition = [0.5, " +
              number(height) +
              ", 0]\nmass = 1\n"
              "[[structure.rods]]\nnodes = ['G', 'O']\nmass = 0\n"
              "[[structure.rods]]\nnodes = ['O', 'A']\nmass = 0\n"
              "[[constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 0, 1]\n"
              "[[constraints]]\nkind = 'coordinate_stop'\nname = 'floor'\nnodes = ['A']\ndirection = [0, 1, "
              "0]\nmin = " +
              number(height + off) +
              "\n[[constraints]]\nkind = 'angle_stop'\nname = 'hinge'\nnodes = ['G', 'O', 'A']\nmin = 120\n"
              "[[forces]]\nkind = 'friction'\nnodes = ['G', 'O', 'A']\nkinetic = 1\n"
              "[gravity]\nacceleration = [0, -9.81, 0]\n[solver]\nend_time = 0.3\n",
          {std::string("solver.method=") + method});
      CAPTURE(off, method, run.message);
      CHECK(run.status == RunStatus::completed);
      CHECK(run.warnings == std::vector<std::string>{});
      CHECK(run.steps < 40);
      CHECK((end_positions(run).tail<3>() - Vec3(0.5, height, 0)).norm() <= 2 * off + 1e-12);
    }
}

}  // namespace digits_of_rest_test
