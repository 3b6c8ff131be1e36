// SPDX-License-Identifier: BSD-3-Clause
// What a row of the constraints counts as round-off is that of its own nodes and of one turn, however large
// or small the rest of the structure is and however often it has gone round.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"

using namespace unfurl;

namespace row_sizes_test {

namespace {

Simulation run_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Scene scene = read_scene_text(text, "rows.toml", overrides);
  return simulate(build_model(scene), scene.solver);
}

long iterations_until(const std::string& text, double end) {
  const Simulation run = run_of(text, {"solver.end_time=" + std::to_string(end)});
  CHECK(run.status == RunStatus::completed);
  return run.newton_iterations;
}

const std::string crank =
    "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
    "{name = 'Z', position = [1, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0], mass = 1}]\n"
    "rods = [{nodes = ['A', 'B'], mass = 1}]\n[[constraints]]\nkind = 'plane'\nnodes = ['B']\n"
    "normal = [0, 0, 1]\n[[constraints]]\nkind = 'angle'\nnodes = ['Z', 'A', 'B']\naxis = [0, 0, 1]\n"
    "motion = 'rate'\nrate = 360\n[solver]\nstep = 0.02\n";

}  // namespace

// theta = 2 pi t: after whole seconds the crank is where it began.
TEST_CASE("a driven crank goes round as often as it is asked to, at the price of its first turns") {
  for (const char* method : {"dvm", "rk4_projected", "generalized_alpha"}) {
    INFO(method);
    const std::string text = crank + "method = '" + method + "'\nend_time = 120\n";
    const Simulation run = run_of(text);
    REQUIRE(run.status == RunStatus::completed);
    const Trajectory& motion = run.trajectory;
    double most = 0;
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const double angle = 2 * pi * std::remainder(motion.time(i), 1.0);
      const VectorXd q = motion.node_positions(i);
      most = std::max(most, std::hypot(q[6] - std::cos(angle), q[7] - std::sin(angle)));
    }
    // Times are known to half an ulp of 120 s, 7e-15 s, at 2 pi m/s.
    CHECK(most < 1e-12);
  }
  CHECK(iterations_until(crank, 80) < 11 * iterations_until(crank, 8));  // as many a step, and a tenth
}

// Free of forces both turn evenly: the first at 2 pi rad/s, the second 0.4 times as fast, the other way.
TEST_CASE("gears turn on after hundreds of turns as in the first") {
  const std::string gears =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'H', position = [0, 0, 0], fixed = true},\n"
      "{name = 'A', position = [1, 0, 0], fixed = true},\n"
      "{name = 'B', position = [0.6, 0.8, 0], velocity = [-5.02654824574367, 3.76991118430775, 0]},\n"
      "{name = 'K', position = [3, 0, 0], fixed = true}, {name = 'C', position = [4, 0, 0], fixed = true},\n"
      "{name = 'D', position = [3, 1, 0]}]\n"
      "rods = [{nodes = ['H', 'B'], mass = 1}, {nodes = ['K', 'D'], mass = 1}]\n"
      "[[constraints]]\nkind = 'plane'\nnodes = ['B', 'D']\nnormal = [0, 0, 1]\n"
      "[[constraints]]\nkind = 'gear'\nnodes = ['A', 'H', 'B', 'C', 'K', 'D']\nradii = [0.2, 0.5]\n"
      "axis = [0, 0, 1]\n[solver]\nend_time = 200\nstep = 0.05\n";
  const Simulation run = run_of(gears);
  REQUIRE(run.status == RunStatus::completed);
  const Trajectory& motion = run.trajectory;
  const VectorXd q = motion.node_positions(motion.size() - 1);
  const double first = std::atan2(q[7], q[6]) - std::atan2(0.8, 0.6),
               second = std::atan2(q[16], q[15] - 3) - pi / 2;
  // Teeth that mesh: r_1 theta_1 + r_2 theta_2 = 0, of angles known up to turns, 0.2 * 2 pi of the sum.
  const double slip = std::remainder(0.2 * first + 0.5 * second, 0.1 * 2 * pi);
  CHECK(std::abs(slip) < 1e-12);
  CHECK(iterations_until(gears, 180) < 11 * iterations_until(gears, 18));
}

// A load at right angles to a crank of 0.3 m grows to 10 N in a second: it turns the hinge's 1.2 N m at 0.4
// s.
TEST_CASE("a hinge holds by its torque, whatever rods are elsewhere") {
  for (const char* beside : {"0.01", "0.3", "50.0"}) {
    INFO(beside);
    const Simulation run = run_of(
        std::string(
            "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},\n"
            "{name = 'G', position = [2, 0, 0], fixed = true}, {name = 'B', position = [0.3, 0, 0], mass = "
            "1},\n"
            "{name = 'P', position = [5, 0, 0], mass = 1}, {name = 'Q', position = ['=5+") +
        beside +
        "', 0, 0], mass = 1}]\nrods = [{nodes = ['A', 'B'], mass = 1}, {nodes = ['P', 'Q'], mass = 1}]\n"
        "[[constraints]]\nkind = 'plane'\nnodes = ['B']\nnormal = [0, 0, 1]\n"
        "[[forces]]\nkind = 'friction'\nname = 'hinge'\nnodes = ['G', 'A', 'B']\naxis = [0, 0, 1]\n"
        "kinetic = 1.0\nstatic = 1.2\n"
        "[[forces]]\nkind = 'load_over_time'\nnodes = ['B']\nforce = [0, 1, 0]\ntimes = [0, 1]\nvalues = [0, "
        "10]\n"
        "[solver]\nend_time = 0.6\nstep = 0.05\n");
    const auto slips =
        std::ranges::find_if(run.events, [](const Event& e) { return e.name == "hinge slips"; });
    REQUIRE(slips != run.events.end());
    CHECK(slips->t == Approx(0.4).epsilon(1e-8));  // located to a billionth of its torque
  }
}

// The same linkage, scaled: of a method that drifts, by the same share.
TEST_CASE("a structure without rods has the size of its nodes' distances") {
  double first = 0;
  for (const char* size : {"1.0", "1e-6", "1e5"}) {
    INFO(size);
    const Simulation run = run_of(
        std::string("[variables]\nL = ") + size +
        "\n[structure]\nkind = 'custom'\nrods = []\nnodes = [{name = 'A', position = [0, 0, 0], fixed = "
        "true},\n"
        "{name = 'B', position = ['=0.6*L', '=-0.8*L', 0], mass = 1},\n"
        "{name = 'C', position = ['=1.6*L', '=-0.8*L', 0], mass = 1}]\n"
        "[[constraints]]\nkind = 'length'\nnodes = ['A', 'B']\n"
        "[[constraints]]\nkind = 'length'\nnodes = ['B', 'C']\n[gravity]\nacceleration = [0, '=-9.81*L', 0]\n"
        "[solver]\nmethod = 'rk4'\nend_time = 2\nstep = 0.1\n");
    const Diagnostics d = diagnose(run);
    const double most = *std::ranges::max_element(d.at("constraint_relative_max").values);
    CHECK(most > 1e-3);
    if (first == 0) first = most;
    CHECK(most == Approx(first).epsilon(1e-6));  // of rounding that the drift has grown
  }
}

}  // namespace row_sizes_test
