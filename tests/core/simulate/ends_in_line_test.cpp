// SPDX-License-Identifier: BSD-3-Clause
// Steps that end where rods lie in one line, to the last digit: the rows say nothing of the velocity there,
// and of the pose the root of round-off.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace ends_in_line_test {

using testing::number;
using testing::run_scene;

namespace {

// A parallelogram of cranks of 1 m that turn by a quarter of a turn a second, `early` rad before the lowest
// pose at t = 0: in line 1 s, 3 s, ... later.
std::string turning(double early, const std::string& driven, double step, int stages, double end,
                    bool hangs = false) {
  const double w = pi / 2, x = -std::sin(early), z = -std::cos(early);
  const auto node = [&](const char* name, double foot) {
    return "{name = '" + std::string(name) + "', position = [" + number(foot + x) + ", 0, " + number(z) +
           "], velocity = [" + number(-w * z) + ", 0, " + number(w * x) + "]}";
  };
  return "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = "
         "'D', "
         "position = [2, 0, 0], fixed = true}, " +
         node("B", 0) + ", " + node("C", 2) +
         (hangs ? ", {name = 'E', position = [9, 0, 0], fixed = true}, {name = 'F', position = [9, 0, -1], "
                  "mass = "
                  "1000}"
                : "") +
         "]\nrods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}, {nodes = ['D', 'C'], "
         "mass = "
         "1}" +
         std::string(hangs ? ", {nodes = ['E', 'F'], mass = 1}" : "") +
         "]\n[[constraints]]\nkind = 'plane'\nnodes = ['B', 'C']\nnormal = [0, 1, 0]\n" + driven +
         "[solver]\nstep = " + number(step) + "\nstages = " + std::to_string(stages) +
         "\nend_time = " + number(end) + "\n";
}

// Of B and C, the largest of all states.
double off(const Simulation& run, double early) {
  double most = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double turn = pi / 2 * run.trajectory.time(i) - early;
    const VectorXd q = run.trajectory.positions(i);
    const Vec3 at(std::sin(turn), 0, -std::cos(turn));
    most = std::max({most, (q.segment<3>(6) - at).norm(), (q.segment<3>(9) - at - Vec3(2, 0, 0)).norm()});
  }
  return most;
}

}  // namespace

// Six states that are up to 0.01 rad apart tell the pose on the line to the sixth power of that, 5e-14;
// of 0.016 rad, 1e-10 of those of 0.03; round-off of 1e-16 is up to 1e-10 of a weak mode in others.
TEST_CASE("an even turn stays even where steps end in line or next to it") {
  for (const double early : {0.0, 1e-15, 1e-12, 1e-10, 1e-9, 1e-7})
    for (const double step : {0.01, 0.05, 0.1})
      for (const int stages : {5, 6, 8}) {
        INFO(early << " rad, steps of " << step << " s, " << stages << " stages");
        const Simulation run = run_scene(turning(early, "", step, stages, 3.5));
        CHECK(run.status == RunStatus::completed);
        CHECK(run.trajectory.end_time() == 3.5);
        CHECK(off(run, early) < 2e-10);
      }
}

// Nothing but the end of the run lies behind, or time has an edge there: a load on a pin begins.
TEST_CASE("a turn that ends in line is even to its end") {
  const std::string load =
      "[[forces]]\nkind = 'load_over_time'\nnodes = ['A']\nforce = [1, 0, 0]\ntimes = [0, 1.01, "
      "1.02]\nvalues = "
      "[0, 0, 1]\n";
  for (const bool edge : {false, true})
    for (const double step : {0.01, 0.05})
      for (const int stages : {3, 5, 8})
        for (const double end : {1.0, 1.02}) {
          INFO("steps of " << step << " s, " << stages << " stages, until " << end << " s, edge: " << edge);
          const Simulation run = run_scene(turning(0, edge ? load : "", step, stages, end));
          INFO(run.message);
          CHECK(run.status == RunStatus::completed);
          CHECK(run.trajectory.end_time() == end);
          // Three stages are of the fourth order in their steps; one side tells six times less than two.
          CHECK(off(run, 0) < (stages == 3 ? 1e-6 : edge ? 1e-8 : 2e-10));
        }
}

// A load that begins there, across one crank alone, asks for forces without bound from the pose on: where no
// step begins in it, it is left as the step had it, to the root of round-off. Steps that pass it by agree.
TEST_CASE("a load that begins in line is followed") {
  const std::string load =
      "[[forces]]\nkind = 'load_over_time'\nnodes = ['B']\nforce = [0, 0, 1]\ntimes = [0, 1, 1, 3]\nvalues = "
      "[0, 0, "
      "1, 1]\n";
  const auto end = [&](double step, int stages) {
    const Simulation run = run_scene(turning(0, load, step, stages, 1.7));
    INFO(step << " s, " << stages << " stages: " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    return Vec3(run.trajectory.positions(run.trajectory.size() - 1).segment<3>(6));
  };
  const Vec3 passed_by = end(0.0071, 6);
  for (const int stages : {5, 8}) CHECK((end(0.01, stages) - passed_by).norm() < 1e-6);
}

// A mass on a rod that gives, beside a slow turn, swings by 2 rad a step: eight stages tell it to 1e-8 of a
// step's error, and the pose on the line does not change that.
TEST_CASE("what swings beside a turn that ends in line goes on swinging") {
  const double w = 0.15, omega = 40, z = -std::cos(pi / 2 - w), x = std::sin(pi / 2 - w);
  const auto node = [&](const char* name, double foot) {
    return "{name = '" + std::string(name) + "', position = [" + number(foot + x) + ", 0, " + number(z) +
           "], velocity = [" + number(-w * z) + ", 0, " + number(w * x) + "]}";
  };
  const Simulation run = run_scene(
      "[structure]\nkind = 'custom'\nrod_model = 'elastic'\nnodes = [{name = 'A', position = [0, 0, 0], "
      "fixed = "
      "true}, {name = 'D', position = [2, 0, 0], fixed = true}, " +
      node("B", 0) + ", " + node("C", 2) +
      ", {name = 'S', position = [6, 0, 0], mass = 1, velocity = [0.04, 0, 0]}, {name = 'E', position = [5, "
      "0, 0], "
      "fixed = true}]\nrods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['B', 'C'], mass = 1}, {nodes = "
      "['D', 'C'], "
      "mass = 1}, {nodes = ['E', 'S'], mass = 1e-9, area = 1e-4, youngs_modulus = "
      "1.6e7}]\n[[constraints]]\nkind = "
      "'plane'\nnodes = ['B', 'C']\nnormal = [0, 1, 0]\n[[constraints]]\nkind = 'line'\nnodes = ['S']\n"
      "direction = [1, 0, 0]\n[solver]\nstep = 0.05\nstages = 8\nend_time = 2\n");
  REQUIRE(run.status == RunStatus::completed);
  const auto& nodes = run.trajectory.structure().nodes;
  const auto at =
      std::ranges::find(nodes, std::string("S"), [](const Node& n) { return std::string(n.name); });
  double most = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double swing = 1e-3 * std::sin(omega * run.trajectory.time(i));
    most = std::max(most, std::abs(run.trajectory.positions(i)[3 * (at - nodes.begin())] - 6 - swing));
  }
  CHECK(most < 1e-10);
}

// Weight across the line asks for forces without bound there: no step begins on it, and the grid goes on
// behind it. A drive leaves the motion no choice.
TEST_CASE("a driven turn under weight passes the line whatever its steps") {
  const std::string drive =
      "[gravity]\nacceleration = [0, 0, -9.81]\n[[constraints]]\nkind = 'angle'\nname = 'm'\nnodes = ['D', "
      "'A', "
      "'B']\naxis = [0, 1, 0]\nmotion = 'rate'\nrate = -90\n";
  for (const double step : {0.01, 0.02, 0.05, 0.1})
    for (const int stages : {3, 5, 8}) {
      const bool hangs = stages == 5;  // a weight beside it, which hides nothing of its forces
      INFO("steps of " << step << " s, " << stages << " stages");
      const Simulation run = run_scene(turning(0, drive, step, stages, 4, hangs));
      INFO(run.message);
      CHECK(run.status == RunStatus::completed);
      CHECK(run.trajectory.end_time() == 4);
      CHECK(off(run, 0) < 1e-12);
    }
}

}  // namespace ends_in_line_test
