// SPDX-License-Identifier: BSD-3-Clause
// Friction on an angle that a drive leads: it turns round where the drive does, whatever the method.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace led_friction_test {

namespace {

using testing::number, testing::run_scene;

constexpr double angle = 126.869897645844;  // of G, O, A [deg]

// A double pendulum O, A, B of which a drive leads the angle at O, against friction there and at A.
std::string led(const std::string& motion) {
  return "[structure]\nkind = 'custom'\n"
         "[[structure.nodes]]\nname = 'G'\nposition = [-1, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'A'\nposition = [0.6, 0.8, 0]\nmass = 1\n"
         "[[structure.nodes]]\nname = 'B'\nposition = [1.5, 0.8, 0]\nmass = 0.7\n"
         "[[structure.rods]]\nnodes = ['G', 'O']\nmass = 0\n"
         "[[structure.rods]]\nnodes = ['O', 'A']\nmass = 0\n"
         "[[structure.rods]]\nnodes = ['A', 'B']\nmass = 0\n"
         "[[constraints]]\nkind = 'plane'\nnodes = ['A', 'B']\nnormal = [0, 0, 1]\n"
         "[[constraints]]\nkind = 'angle'\nnodes = ['G', 'O', 'A']\n" +
         motion +
         "[[forces]]\nkind = 'friction'\nname = 'led'\nnodes = ['G', 'O', 'A']\nkinetic = 2\n"
         "[[forces]]\nkind = 'friction'\nname = 'free'\nnodes = ['O', 'A', 'B']\nkinetic = 3\n"
         "[gravity]\nacceleration = [0, -9.81, 0]\n";
}

std::vector<double> turns(const Simulation& run) {
  std::vector<double> out;
  for (const Event& event : run.events)
    if (event.element == "led" && event.t > 0) out.push_back(event.t);
  return out;
}

const char* const methods[] = {"dvm", "generalized_alpha", "rk4", "rk4_projected", "rk4_baumgarte"};

}  // namespace

// A clamped spline through values that are odd about 0.5 s, but for a constant: the times at which it turns
// add up to 1 s.
TEST_CASE("friction on what a drive leads turns round once where the drive does") {
  const std::string motion = "motion = 'table'\ntimes = [0, 0.25, 0.5, 0.75, 1]\nvalues = [" + number(angle) +
                             ", " + number(angle + 20) + ", " + number(angle) + ", " + number(angle - 20) +
                             ", " + number(angle) + "]\n";
  const auto turning = [&](const char* method, const char* step) {
    const Simulation run = run_scene(led(motion) + "[solver]\nend_time = 0.95\n",
                                     {std::string("solver.method=") + method, step});
    CAPTURE(method, step);
    CHECK(run.warnings == std::vector<std::string>{});
    const std::vector<double> found = turns(run);
    REQUIRE(found.size() == 2);
    CHECK(found[0] + found[1] == Approx(1).epsilon(0).margin(1e-9));
    return found[0];
  };
  const double expected = turning("dvm", "solver.step=0.01");
  for (const char* method : methods)
    for (const char* step : {"solver.step=0.01", "solver.step=0.003"})
      CHECK(turning(method, step) == Approx(expected).epsilon(0).margin(1e-9));
}

// It stops with a rate that goes to zero with the square of the time left.
TEST_CASE("friction on what a drive brings to rest does not turn round there") {
  for (const char* method : methods) {
    const Simulation run = run_scene(
        led("motion = 'smooth'\nto = 150\nstart = 0.1\nduration = 0.2\n") + "[solver]\nend_time = 0.32\n",
        {std::string("solver.method=") + method});
    CAPTURE(method);
    CHECK(run.warnings == std::vector<std::string>{});
    CHECK(run.steps < 60);
    REQUIRE(turns(run).size() == 1);  // slips
    CHECK(turns(run)[0] == Approx(0.1).epsilon(0).margin(1e-4));
  }
}

}  // namespace led_friction_test
