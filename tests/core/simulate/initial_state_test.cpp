// SPDX-License-Identifier: BSD-3-Clause
// Where a run starts and how it meets the ends of its time: custom structures with pins, odd steps.
#include <catch2/catch.hpp>

#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace initial_state_test {

namespace {

// A point of 1 kg on a massless rod of 1 m, pinned at a massless node, released level.
Structure point_pendulum(double vertical_speed = 0) {
  CustomSpec spec;
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true}, {"A", {1, 0, 0}, {0, 0, vertical_speed}, 1.0, false}};
  spec.rods = {{"OA", {"O", "A"}, 0.0}};
  Structure structure = build_custom(spec);
  structure.gravity = {0, 0, -9.81};
  return structure;
}

}  // namespace

TEST_CASE("a massless pin needs no mass, whether linear constraints are eliminated or kept") {
  VectorXd end[2];
  for (bool eliminate : {true, false}) {
    const Simulation run = simulate(make_model(point_pendulum(), eliminate), dvm_options(5, 0.01, 1.0));
    REQUIRE(run.status == RunStatus::completed);
    const State& last = run.trajectory.state(run.trajectory.size() - 1);
    VectorXd q(6), v(6);
    run.trajectory.model().system.expand(last.z, q);
    run.trajectory.model().system.expand_rate(last.w, v);
    // Energy: v^2 / 2 = g * drop. Order 8 at h = 0.01 leaves about 1e-14; 1e-11 is far above round-off.
    CHECK(0.5 * v.tail<3>().squaredNorm() == Approx(-9.81 * q[5]).epsilon(1e-11));
    end[eliminate] = q;
  }
  CHECK((end[0] - end[1]).lpNorm<Eigen::Infinity>() < 1e-12);
}

TEST_CASE("a step longer than the run is cut to the run") {
  const Simulation run = simulate(make_model(point_pendulum()), dvm_options(4, 5.0, 0.05));
  CHECK(run.status == RunStatus::completed);
  CHECK(run.steps == 1);
  CHECK(run.trajectory.end_time() == 0.05);
}

TEST_CASE("velocities along the rods are taken away with a warning, those that fit are not") {
  Structure stretched = point_pendulum(2.0);
  const auto warning_of = [](const Structure& s) {
    return velocity_warning(initial_state(s, System(s, true)), s);
  };
  CHECK(warning_of(stretched).empty());
  stretched.nodes[1].velocity.x() = 1e-3;
  CHECK(warning_of(stretched).find("0.001 m/s") != std::string::npos);
}

TEST_CASE("where a drive sets out at speed no velocity was given that would have to be warned of") {
  const std::string led = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], mass = 2}, {name = "O", position = [0, 0, 0], fixed = true}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]}]
[[constraints]]
kind = "length"
nodes = ["O", "A"]
motion = "rate"
rate = 0.2
[solver]
end_time = 0.1
)";
  CHECK(run_scene(led).warnings.empty());
  // Against what was given, the other way.
  CHECK(run_scene(led, {"structure.nodes[0].velocity=[-0.1, 0, 0]"}).warnings.size() == 1);
  // Beside it what flies by itself, as it was given; and across its guide, which it was not.
  const std::string beside =
      "structure.nodes[2]={name=\"B\", position=[0, 3, 0], mass=1, velocity=[1, 0.5, 0]}";
  CHECK(run_scene(led, {beside}).warnings.empty());
  CHECK(run_scene(led, {beside, "structure.constraints[1]={kind=\"line\", nodes=[\"B\"], direction=[1,0,0]}"})
            .warnings.size() == 1);
}

}  // namespace initial_state_test
