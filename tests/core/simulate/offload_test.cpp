// SPDX-License-Identifier: BSD-3-Clause
// Ropes that carry a structure's weight in the laboratory.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/study/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace offload_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

// Two rods with odd masses, turning, under a gravity that is along no axis.
const std::string arms = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0.1, -0.2, 0.3], fixed = true},
  {name = "A", position = [0.73, 0.31, -0.17], velocity = [0.4, 1.1, -0.6]},
  {name = "B", position = [1.21, -0.14, -0.62], velocity = [-0.3, 0.9, 1.3], mass = 0.37}]
rods = [{nodes = ["O", "A"], mass = 1.3}, {nodes = ["A", "B"], mass = 0.7}]
[gravity]
acceleration = [0.7, -1.9, -9.1]
[[forces]]
kind = "offload"
nodes = ["*"]
trolley = "following"
[solver]
stages = 4
step = 0.01
end_time = 1.5
)";

const std::string mass = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0.4, 0.3, 1], velocity = [0.3, -0.2, 0], mass = 1.7}]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "offload"
name = "rope"
nodes = ["A"]
length = 2.3
[solver]
stages = 5
step = 0.02
end_time = 4
)";

}  // namespace

TEST_CASE("under trolleys that follow, the test at 1 g is the flight at 0 g") {
  const Simulation flight = run_scene(arms, {"gravity.acceleration=[0,0,0]", "forces[0].enabled=false"});
  for (const Method& method : methods()) {
    const std::string chosen = "solver.method=" + std::string(method.name);
    const Simulation tested = run_scene(arms, {chosen}),
                     same =
                         run_scene(arms, {chosen, "gravity.acceleration=[0,0,0]", "forces[0].enabled=false"});
    INFO(method.name);
    REQUIRE(tested.status == RunStatus::completed);
    // Weights cancel to round-off, which a hundred and fifty steps of a tumbling chain grow.
    CHECK((end_positions(tested) - end_positions(same)).lpNorm<Eigen::Infinity>() <= 1e-11);
    CHECK(testing::largest(diagnose(tested), "energy_balance_J") <=
          testing::largest(diagnose(same), "energy_balance_J") + 1e-11);
  }
  // Without it the arms fall: it does something.
  const Simulation falls = run_scene(arms, {"forces[0].enabled=false"});
  CHECK((end_positions(falls) - end_positions(flight)).lpNorm<Eigen::Infinity>() > 0.1);
}

TEST_CASE("a free mass under a trolley that stays swings with the pendulum's period") {
  const Simulation run = run_scene(mass);
  REQUIRE(run.status == RunStatus::completed);
  const double omega = std::sqrt(9.81 / 2.3), swing = std::sin(4 * omega) / omega;
  const VectorXd q = end_positions(run);
  // Order 8 at omega h = 0.04.
  CHECK(q[0] == Approx(0.4 + 0.3 * swing).epsilon(0).margin(1e-12));
  CHECK(q[1] == Approx(0.3 - 0.2 * swing).epsilon(0).margin(1e-12));
  CHECK(q[2] == Approx(1).epsilon(0).margin(1e-12));
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-12);
  // From a trolley 0.5 m aside, at rest: x_t + 0.5 cos(omega t).
  const Simulation aside = run_scene(
      mass, {"forces[0].position=[0.4,0.8,9]", "structure.nodes.A.velocity=[0,0,0]", "solver.end_time=3"});
  CHECK(end_positions(aside)[1] == Approx(0.8 - 0.5 * std::cos(3 * omega)).epsilon(0).margin(1e-12));
}

TEST_CASE("an offload that cannot be is refused, one without weight says that it does nothing") {
  CHECK(error_of(mass, {"forces[0].length=0"}).find("length: must be") != std::string::npos);
  CHECK(error_of(mass, {"forces[0].length=-2"}).find("length: must be") != std::string::npos);
  CHECK(error_of(mass, {"forces[0].position=[1,2]"}).find("position: must be three numbers") !=
        std::string::npos);
  const Simulation weightless = run_scene(mass, {"gravity.acceleration=[0,0,0]"});
  REQUIRE(weightless.warnings.size() == 1);
  CHECK(weightless.warnings[0].find("does nothing without a weight") != std::string::npos);
}

}  // namespace offload_test
