// SPDX-License-Identifier: BSD-3-Clause
// Structures of which every node is held: nothing moves, forces change all the same.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace held_structure_test {

namespace {

std::string tripod(const std::string& more) {
  return R"([structure]
kind = 'custom'
youngs_modulus = 7e10
nodes = [{name = 'A', position = [0.1, 0.2, 0], fixed = true}, {name = 'B', position = [1.9, 0, 0.3], fixed = true},
         {name = 'C', position = [0.4, 2.2, 0.1], fixed = true}, {name = 'P', position = [0.6, 0.5, 1], mass = 1.3, fixed = true}]
rods = [{nodes = ['A', 'P'], mass = 0.7, area = 3e-4}, {nodes = ['B', 'P'], mass = 1, area = 1e-4},
        {nodes = ['C', 'P'], mass = 1, area = 1e-4}]
[solver]
step = 1e-2
end_time = 0.07
)" + more;
}

}  // namespace

TEST_CASE("every method runs a structure without a coordinate to solve for") {
  const double e = 23e-6 * -60;
  for (const Method& method : methods()) {
    INFO(method.name);
    const std::string name = "solver.method=" + std::string(method.name);
    // Rods that share forces: there is none to share.
    const Simulation still = run_scene(tripod(""), {name});
    REQUIRE(still.status == RunStatus::completed);
    CHECK(still.trajectory.time(still.trajectory.size() - 1) == Approx(0.07).epsilon(1e-12));
    CHECK(diagnose(still).axial_force.lpNorm<Eigen::Infinity>() == 0.0);
    // Rods that give: one that gets colder pulls by N = -E A e, e = alpha dT, on nodes that stay.
    // Round-off of its length is 1e-16 / 1e-3 of that.
    const Simulation cold = run_scene(tripod(R"([[forces]]
kind = 'temperature'
rods = ['A-P']
expansion = 23e-6
change = -60
times = [0, 0.02, 0.05]
values = [0, 0.4, 1]
)"),
                                      {name, "structure.rod_model=elastic"});
    INFO(cold.message);
    REQUIRE(cold.status == RunStatus::completed);
    const MatrixXd force = diagnose(cold).axial_force;
    CHECK(force(force.rows() - 1, 0) == Approx(-7e10 * 3e-4 * e).epsilon(1e-10));
    CHECK(force.rightCols(2).lpNorm<Eigen::Infinity>() < 1e-6);
  }
}

TEST_CASE("rods that do not fit between nodes that are held have the force of that") {
  const double apart = Vec3(0.5, 0.3, 1).norm(), made = 1.001 * apart;
  const Simulation run = run_scene(
      tripod(""), {"structure.rod_model=elastic", "structure.rods[0].length=" + std::to_string(made)});
  REQUIRE(run.status == RunStatus::completed);
  // std::to_string leaves six digits of the length: 1e-6 of 1e-3.
  CHECK(diagnose(run).axial_force(0, 0) ==
        Approx(7e10 * 3e-4 * (apart / std::stod(std::to_string(made)) - 1)).epsilon(1e-9));
}

}  // namespace held_structure_test
