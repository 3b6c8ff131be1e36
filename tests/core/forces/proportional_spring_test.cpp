// SPDX-License-Identifier: BSD-3-Clause
// Springs of no free length, which pull with k d: also where both ends are at one place.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/diagnostics/vibration.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace proportional_spring_test {

using testing::end_positions, testing::error_of, testing::largest, testing::model_of, testing::run_scene;

namespace {

// 2 kg on 8 N/m, thrown from the spring's other end: 2 rad/s.
const std::string thrown = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0.5, 0, 0], fixed = true},
  {name = "B", position = [0.5, 0, 0], velocity = [0.3, 0.4, 0], mass = 2}]
[[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 8
free_length = 0
[solver]
stages = 4
end_time = 1
)";

// A rod of 1 kg and 2 m stands on its hinge, 1.5 kg at its tip and 0.5 kg at b = 0.8 m, from where a spring
// goes to a = 0.8 m above the hinge. k a b = g (m r) balances it in every pose; it turns by 1 rad/s.
const std::string balanced = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "H", position = [0, 0, 0.8], fixed = true},
  {name = "B", position = [0, 0, 0.8], velocity = [0.8, 0, 0], mass = 0.5},
  {name = "A", position = [0, 0, 2], velocity = [2, 0, 0], mass = 1.5}]
rods = [{nodes = ["O", "A"], mass = 1}, {nodes = ["O", "B"], mass = 0}]
[[structure.constraints]]
kind = "collinear"
nodes = ["O", "A", "B"]
[[structure.constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 1, 0]
[[forces]]
kind = "spring"
nodes = ["H", "B"]
stiffness = 68.75
free_length = 0
[gravity]
acceleration = [0, 0, -10]
[solver]
stages = 4
end_time = 2
)";

}  // namespace

TEST_CASE("a mass thrown from the other end of a spring of no free length is a sine") {
  // x = v / w sin(w t); at h w = 0.02 the error of the sixth order is some 1e-12 of it, rk4's some 1e-9.
  for (const auto& [method, allowed] : {std::pair{"dvm", 1e-11}, {"rk4", 1e-8}}) {
    const Simulation run = run_scene(thrown, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.warnings.empty());
    const VectorXd x = end_positions(run);
    CHECK(std::abs(x[3] - (0.5 + 0.15 * std::sin(2.0))) <= allowed);
    CHECK(std::abs(x[4] - 0.2 * std::sin(2.0)) <= allowed);
    CHECK(largest(diagnose(run), "energy_balance_J") <= allowed);
  }
}

TEST_CASE("a spring of no free length pulls back in every direction at its other end") {
  const auto model = model_of(thrown);
  const Vibration found = vibration(*model, initial_state(model->structure, model->system).state);
  REQUIRE(found.modes.size() == 3);
  for (const VibrationMode& mode : found.modes) {
    CHECK(mode.growth == 0);
    CHECK(mode.frequency == Approx(1 / std::numbers::pi).epsilon(1e-12));  // sqrt(8 / 2) / 2 pi
  }
}

TEST_CASE("an arm balanced by a spring of no free length turns evenly from where its ends meet") {
  for (const char* model : {"full", "path"}) {
    const Simulation run = run_scene(balanced, {std::string("solver.model=") + model});
    REQUIRE(run.status == RunStatus::completed);
    const VectorXd x = end_positions(run);
    // No torque: two radians in two seconds, to the round-off of 200 steps.
    CHECK(std::abs(x[9] - 2 * std::sin(2.0)) <= 1e-11);
    CHECK(std::abs(x[11] - 2 * std::cos(2.0)) <= 1e-11);
    CHECK(largest(diagnose(run), "energy_balance_J") <= 1e-10);
  }
}

TEST_CASE("what needs the direction of a spring is refused where its ends begin at one place") {
  for (const char* change :
       {"forces[0].free_length=0.1", "forces[0].damping=1", "forces[0].tension_only=true"})
    CHECK(error_of(thrown, {change}).find("must not be at the same place") != std::string::npos);
}

}  // namespace proportional_spring_test
