// SPDX-License-Identifier: BSD-3-Clause
// Runs that end a moment before the deployed pose, in which no step can be solved.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/table.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace end_beside_flat_test {

// It is not deployed then: its fold angle is what is left of the way, rate times time, but for the square of
// that (of a rate that changes by itself within a radian), and what rounding moves hinges in line by, 1e-8 of
// a rod. A method of order 2 tells the time itself to 5e-6 s (2e-5 s with steps twice as long), from step to
// step otherwise. It is as fast there as at the pose, but for the 2.5 a second that it gains on the way.
TEST_CASE("a run that ends just before the flat pose ends when it was told to") {
  struct Way {
    std::vector<std::string> changes;
    double known;  // [s]
  };
  const std::vector<Way> ways{{{"solver.method=generalized_alpha", "solver.step=0.005"}, 5e-6},
                              {{"solver.method=generalized_alpha"}, 2e-5},
                              {{"solver.stages=6"}, 0},
                              {{"solver.stages=4"}, 0}};
  for (const Way& way : ways) {
    const Scene whole = read_scene_file(find_scene("hoop6"), way.changes);
    const Simulation run = simulate(build_model(whole), whole.solver);
    REQUIRE(run.status == RunStatus::deployed);
    const double deployed = run.trajectory.end_time();
    const std::size_t last = run.trajectory.size() - 1;
    const Deployment& deployment = run.trajectory.structure().deployment;
    const double rate = deployment.fold_rate(run.trajectory.positions(last), run.trajectory.velocities(last));
    for (const double before : {3e-4, 9e-5, 1e-5, 1e-6, 1e-9, 1e-11}) {
      if (before < way.known) continue;
      std::vector<std::string> early = way.changes;
      early.push_back("solver.end_time=" + exact_number(deployed - before));
      const Scene scene = read_scene_file(find_scene("hoop6"), early);
      const Simulation ends = simulate(build_model(scene), scene.solver);
      CAPTURE(early.front(), before, ends.message);
      CHECK(ends.status == RunStatus::completed);
      CHECK(ends.events.empty());
      CHECK(ends.trajectory.end_time() == scene.solver.end_time);
      const VectorXd q = ends.trajectory.positions(ends.trajectory.size() - 1);
      CHECK(std::abs(deployment.fold_angle(q) + rate * before) <
            std::abs(rate) * (2 * before * before + way.known) + 2e-8);
      const std::size_t end = ends.trajectory.size() - 1;
      CHECK(ends.trajectory.velocities(end).norm() ==
            Approx(run.trajectory.velocities(last).norm()).epsilon(3 * (before + way.known) + 1e-9));
    }
  }
}

TEST_CASE("a flat pose is found singular at any size") {
  // 155 cranks with a mass of 1 kg each and the rods between them fall as one pendulum from 60 degrees to
  // their line: v^2 = 2 g sin(60 deg). They have 310 coordinates; whole steps may get through to the line, by
  // rounding, with rates off by 1e-2 m/s.
  const char* const cranks = R"(
[structure]
kind = "custom"
nodes = [{repeat = {i = "0:155"}, name = "A{i}", position = ["=i/20", 0, 0], fixed = true},
         {repeat = {i = "0:155"}, name = "B{i}", position = ["=i/20+0.5", 0, 0.8660254037844386], mass = 1}]
rods = [{repeat = {i = "0:155"}, nodes = ["A{i}", "B{i}"], mass = 0},
        {repeat = {i = "0:154"}, nodes = ["B{i}", "B{i+1}"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "angle A1 A0 B0 about 0 -1 0"
deployed = 0
[solver]
end_time = 1
)";
  const double speed = std::sqrt(2 * 9.81 * std::sqrt(0.75));
  for (const char* steps : {"{step = 0.01, stages = 4}", "{step = 0.0047, method = 'rk4'}",
                            "{step = 0.0042, method = 'rk4'}", "{step = 0.0032, method = 'rk4'}"}) {
    INFO(steps);
    const Simulation run = testing::run_scene(cranks, {std::string("solver=") + steps, "solver.end_time=1"});
    REQUIRE(run.status == RunStatus::deployed);
    const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
    for (Index i = 155; i < 310; ++i) {
      INFO(i);
      // rk4 leaves 1e-6 of the energy behind; along the line nothing moves.
      REQUIRE(v[3 * i + 2] == Approx(-speed).epsilon(2e-6));
      REQUIRE(std::abs(v[3 * i]) < 2e-6 * speed);
    }
  }
}

TEST_CASE("the state of a flat pose beside a short load is found to all digits by every method") {
  // Two parallel cranks with the coupler between them fall into one line; a load on one of them begins 1 ms
  // before. They turn at one rate.
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
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
[[forces]]
kind = "load_over_time"
nodes = ["B0"]
force = [0, 0, 1]
times = [0, 0.5368480610213224, 0.5378480610213224, 0.5388480610213224, 9]
values = [0, 0, 93.44351775590621, 0, 0]
[solver]
step = 0.002
end_time = 1
)";
  for (const char* method : {"dvm", "rk4", "rk4_projected", "rk4_baumgarte", "generalized_alpha"}) {
    INFO(method);
    const Simulation run = testing::run_scene(cranks, {std::string("solver.method=") + method});
    REQUIRE(run.status == RunStatus::deployed);
    const VectorXd v = run.trajectory.node_velocities(run.trajectory.size() - 1);
    // Their difference is extrapolated from poses where it is some 1e-3 of the rate, to 1e-4 of that; a
    // method of order 2 leaves ten times as much.
    CHECK(v[8] == Approx(v[14]).epsilon(std::string(method) == "generalized_alpha" ? 2e-6 : 2e-7));
    CHECK(v[8] < -4.4);
  }
}

}  // namespace end_beside_flat_test
