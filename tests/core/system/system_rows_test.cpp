// SPDX-License-Identifier: BSD-3-Clause
// Rows by their names, and matrices that are kept dense.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace system_rows_test {

namespace {

// Two links of a crane on a rail that is driven along x, its hook held at a height.
const char* const crane =
    "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0.2, 0, 0], mass = 3}, {name = 'A', "
    "position = [0.7, 0, 1.1]}, {name = 'B', position = [1.9, 0.3, 1.6], mass = 0.4}]\n"
    "rods = [{nodes = ['O', 'A'], mass = 1.3}, {nodes = ['A', 'B'], mass = 0.8}]\n"
    "constraints = [{kind = 'line', nodes = ['O'], direction = [1, 0, 0]}, {kind = 'plane', nodes = ['A'], "
    "normal = [0.6, 0.8, 0]}, {kind = 'coordinate', name = 'height', nodes = ['B'], direction = [0, 0, 1]}, "
    "{kind = 'coordinate', name = 'travel', nodes = ['O'], direction = [1, 0, 0], motion = 'rate', rate = "
    "0.3}, "
    "{kind = 'length', name = 'luff', nodes = ['O', 'B'], motion = 'smooth', to = 2.2, duration = 2}]\n";

}  // namespace

TEST_CASE("drives and constraints lead to their rows") {
  for (const char* eliminate : {"true", "false"}) {
    INFO(eliminate);
    const auto model = testing::model_of(crane, {std::string("solver.eliminate_linear=") + eliminate});
    const System& system = model->system;
    std::vector<std::string> driven;
    for (const Drive& drive : system.drives()) {
      driven.push_back(drive.name);
      CHECK(system.constraint_names()[static_cast<std::size_t>(drive.row)] == drive.name);
      CHECK(system.constraint_row(drive.constraint) == drive.row);
    }
    CHECK(driven == std::vector<std::string>{"travel", "luff"});
    for (std::size_t r = 0; r < model->structure.rods.size(); ++r)
      CHECK(system.constraint_names()[static_cast<std::size_t>(system.rod_rows()[r])] ==
            "rod " + model->structure.rods[r].name);
  }
}

TEST_CASE("a mass matrix that is kept dense has the same entries and all of them") {
  const auto sparse = testing::model_of(crane), dense = testing::model_of(crane, {"solver.sparse=false"});
  const MatrixXd wanted(sparse->system.mass());
  CHECK(MatrixXd(dense->system.mass()) == wanted);
  CHECK(dense->system.mass().nonZeros() == wanted.size());
}

// A controller's integral is a coordinate that nothing accelerates.
TEST_CASE("what moves has its mass and the integral of a controller none that could be moved") {
  const auto model = testing::model_of(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0.1, 0, 0], fixed = true}, {name = "
      "'B', "
      "position = [1.2, 0.3, 0]}, {name = 'C', position = [1.9, 1.4, 0.2], mass = 0.6}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1.3}, {nodes = ['B', 'C'], mass = 0.7}]\n"
      "[[forces]]\nkind = 'motor'\nnodes = ['A', 'B', 'C']\nstall_torque = 0.1\nno_load_speed = 3000\n"
      "inertia = 2e-4\ncontrol = 'position'\nproportional = 1.5\nintegral = 0.8\n");
  const System& system = model->system;
  REQUIRE(system.integrals() == 1);
  const VectorXd m = system.moving_mass(), all = system.mass().diagonal();
  CHECK((m.array() == std::numeric_limits<double>::infinity()).count() == 1);
  VectorXd w = VectorXd::Zero(m.size());
  for (Index i = 0; i < m.size(); ++i) {  // as it moves alone
    w.setZero();
    w[i] = 1.7;
    if (std::isfinite(m[i])) CHECK(m[i] == all[i]);
    CHECK(system.kinetic_energy(w) ==
          Approx(std::isfinite(m[i]) ? 0.5 * m[i] * 1.7 * 1.7 : 0.0).epsilon(1e-14));
  }
}

}  // namespace system_rows_test
