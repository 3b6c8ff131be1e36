// SPDX-License-Identifier: BSD-3-Clause
// Flat deployed poses told by a measure that turns round there.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace touched_flat_test {

// Two parallel cranks of 1 m and the coupler between them, 1 kg each, fall from 60 degrees into one line.
const char* const cranks = R"(
[structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
         {name = "B0", position = [0.5, 0, 0.8660254037844386]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
         {name = "B1", position = [1.2, 0, 0.8660254037844386]}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1}]
[[structure.constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "angle X A0 B0"
deployed = 0
[solver]
end_time = 1
)";

TEST_CASE("a flat pose is deployed by an angle without an axis and by lengths, too") {
  struct Told {
    const char* measure;
    const char* deployed;
  };
  const Told measures[] = {{"angle X A0 B0", "0"}, {"length A0 B1", "1.7"}, {"length X B0", "8"}};
  // (2/3 + 1) w^2 / 2 = 2 g sin(60 deg); that nothing is missed, and nothing taken that a step got through
  // to.
  const double speed = std::sqrt(4 * 9.81 * std::sqrt(0.75) / (5.0 / 3));
  const std::string four = "{step = 0.01, stages = 4", five = "{step = 0.0047, stages = 5",
                    six = "{step = 0.0047, stages = 6", rk4 = "{method = 'rk4', step = 0.002";
  for (const Told& told : measures)
    for (const std::string& solver : {four, five, six, rk4})
      for (const char* then : {"stop", "pass"}) {
        CAPTURE(told.measure, solver, then);
        const Simulation run = testing::run_scene(
            cranks, {std::string("deployment.measure=") + told.measure,
                     std::string("deployment.deployed=") + told.deployed,
                     "solver=" + solver + ", end_time = 0.7, at_deployed = '" + then + "'}"});
        const auto is_deployed = [](const Event& event) { return event.kind == "deployed"; };
        const auto event = std::find_if(run.events.begin(), run.events.end(), is_deployed);
        REQUIRE(event != run.events.end());
        // Quadrature of dt = d theta / w. Four stages leave 2e-10 s; of rk4 the rods' lengths drift by
        // 2e-10 m, which moves the pose by 3e-8 s.
        CHECK(event->t == Approx(0.5378480613).epsilon(0).margin(solver == rk4 ? 1e-7 : 1e-9));
        if (then == std::string("pass")) continue;
        const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
        for (const Index node : {2, 4})
          CHECK(v[3 * node + 2] == Approx(-speed).epsilon(0).margin(solver == rk4 ? 1e-6 : 1e-7));
      }
}

TEST_CASE("what turns round just before its deployed value is not deployed") {
  // 8 m is the least length; shares of 2e-4 and 2e-7 of the way are left.
  for (const char* deployed : {"7.9999", "7.9999999"})
    for (const char* solver : {"{step = 0.01, stages = 4", "{step = 0.0047, stages = 5"}) {
      CAPTURE(deployed, solver);
      const Simulation run = testing::run_scene(
          cranks, {"deployment.measure=length X B0", std::string("deployment.deployed=") + deployed,
                   std::string("solver=") + solver + ", end_time = 0.7}"});
      CHECK(run.status == RunStatus::completed);
      for (const Event& event : run.events) CHECK(event.kind == "singular_pose");
    }
}

}  // namespace touched_flat_test
