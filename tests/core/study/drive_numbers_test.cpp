// SPDX-License-Identifier: BSD-3-Clause
// The turn of a rotor and the integral of a controller move as nodes do, but they are nowhere in space: no
// speed, no error and no size of a structure is theirs.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/study/reference.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace drive_numbers_test {

namespace {

// An arm of 0.1 m; a motor with a rotor and an integral brings it to 60 deg.
const std::string arm = R"(
[structure]
kind = "custom"
nodes = [{name = "G", position = [5, 0, 0], fixed = true}, {name = "A", position = [4, 0, 0], fixed = true},
         {name = "B", position = [4.1, 0, 0], mass = 1}]
rods = [{nodes = ["G", "A"], mass = 0}, {nodes = ["A", "B"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 0, 1]
[[forces]]
kind = "motor"
nodes = ["G", "A", "B"]
axis = [0, 0, 1]
stall_torque = 1
no_load_speed = 6000
inertia = 1e-3
control = "position"
proportional = 0.5
derivative = 0.05
integral = 0.1
motion = "smooth"
to = 120
duration = 1
[solver]
end_time = 2
step = 0.02
)";

}  // namespace

TEST_CASE("a peak of speed is that of a node, not of a rotor") {
  const Simulation run = testing::run_scene(arm);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  double fastest = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd v = run.trajectory.velocities(i);
    for (Index k = 0; k + 2 < v.size(); k += 3) fastest = std::max(fastest, v.segment<3>(k).norm());
  }
  REQUIRE(fastest > 0.01);
  // Between states it may be a little more: steps of 0.02 s of a motion of 1 s.
  CHECK(find_measure("peak_speed").value(run, d) == Approx(fastest).epsilon(1e-3));
  CHECK(solved_as(run).name == "full");
}

TEST_CASE("a structure is as large as its nodes in space are apart") {
  CHECK(structure_size(*testing::model_of(arm)) == Approx(1).epsilon(1e-12));
}

TEST_CASE("what start velocities are changed by is told of nodes") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.01, 0.01, 0], mass = 1},
         {name = "C", position = [0.02, 0, 0], velocity = [0.03, 0.02, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 0}, {nodes = ["B", "C"], mass = 0}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 0, 1]
[[constraints]]
kind = "line"
nodes = ["C"]
direction = [1, 0, 0]
[[forces]]
kind = "motor"
nodes = ["A", "B", "C"]
axis = [0, 0, 1]
stall_torque = 1e-3
no_load_speed = 6000
inertia = 1e-4
)");
  const InitialState start = initial_state(model->structure, model->system);
  VectorXd v(model->system.coordinates());
  model->system.expand_rate(start.state.w, v);
  const double most = (v.segment<3>(6) - model->structure.nodes[2].velocity).norm();
  REQUIRE(most > 0.01);
  CHECK(start.velocity_change == Approx(most).epsilon(1e-12));
}

}  // namespace drive_numbers_test
