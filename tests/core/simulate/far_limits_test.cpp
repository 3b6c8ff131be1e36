// SPDX-License-Identifier: BSD-3-Clause
// Stops whose limits are neither zero nor lower ones, and what a run tells of its progress.
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "tests/support/scene_run.hpp"

using namespace unfurl;
using testing::end_positions, testing::run_scene;

namespace far_limits_test {

namespace {

// A ball of 0.7 kg between z = -0.35 m and z = 0.8 m, along a slanting gravity of +-9 m/s^2.
std::string ball(double g, double speed, double restitution) {
  const auto text = [](double x) { return std::to_string(x); };
  return R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "A"
position = [0.3, 0.2, 0.15]
velocity = [0.4, 0, )" +
         text(speed) + R"(]
mass = 0.7
[[constraints]]
kind = "coordinate_stop"
name = "box"
nodes = ["A"]
direction = [0, 0, 1]
min = -0.35
max = 0.8
restitution = )" +
         text(restitution) + R"(
[gravity]
acceleration = [0, 0, )" +
         text(g) + R"(]
[solver]
step = 0.03
end_time = 0.75
)";
}

}  // namespace

TEST_CASE("what comes to rest on a stop stays at its limit, wherever that is and on whichever side") {
  for (const bool below : {true, false}) {
    const double limit = below ? -0.35 : 0.8, height = std::abs(0.15 - limit);
    const Simulation run = run_scene(ball(below ? -9 : 9, 0, 0));
    INFO((below ? "min: " : "max: ") << run.message);
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() == 1);
    // Free fall to it, no rebound: all of m g height is lost. The parabola is followed exactly.
    CHECK(run.events[0].t == Approx(std::sqrt(2 * height / 9)).epsilon(1e-11));
    CHECK(run.events[0].energy_lost == Approx(0.7 * 9 * height).epsilon(1e-10));
    const std::size_t last = run.trajectory.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const VectorXd q = run.trajectory.node_positions(i);
      CHECK((below ? q[2] - limit : limit - q[2]) >= -1e-11);
      if (run.trajectory.time(i) <= run.events[0].t) continue;
      CHECK(q[2] == Approx(limit).epsilon(0).margin(1e-11));
      CHECK(q[0] == Approx(0.3 + 0.4 * run.trajectory.time(i)).epsilon(0).margin(1e-10));  // it slides on
    }
    CHECK(std::abs(run.trajectory.node_velocities(last)[2]) <= 1e-11);
  }
}

TEST_CASE("a stop that is touched and left within one step is not missed on either side") {
  for (const bool below : {true, false}) {
    // Thrown against it at 6 m/s, drawn back at 9 m/s^2: touched at the first root of d - 6 t + 4.5 t^2 and
    // left with 0.8 of the speed there; the step of 0.75 s ends far from it.
    const double sign = below ? 1 : -1, d = below ? 0.5 : 0.65, r = std::sqrt(36 - 18 * d), hit = (6 - r) / 9;
    const Simulation run =
        run_scene(ball(9 * sign, -6 * sign, 0.8), {"solver.step=0.3", "solver.end_time=0.3"});
    REQUIRE(run.status == RunStatus::completed);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].t == Approx(hit).epsilon(1e-10));
    const double after = 0.3 - hit, expected = 0.8 * r * after + 4.5 * after * after;
    const VectorXd q = end_positions(run);
    CHECK((q[2] - (below ? -0.35 : 0.8)) * sign == Approx(expected).epsilon(1e-10));
  }
}

TEST_CASE("progress is a share: it rises from 0 to 1 whatever the end time") {
  for (const char* end : {"solver.end_time=0.3", "solver.end_time=3"}) {
    const Scene scene = read_scene_text(ball(-9, 0, 0.5), "test.toml", {end, "solver.step=0.03"});
    std::vector<double> told;
    SimulationHooks hooks;
    hooks.progress = [&](double fraction) { told.push_back(fraction); };
    hooks.cancelled = [] {  // slow enough to be told of
      std::this_thread::sleep_for(std::chrono::milliseconds(8));
      return false;
    };
    REQUIRE(simulate(build_model(scene), scene.solver, hooks).status == RunStatus::completed);
    REQUIRE(told.size() >= 2);
    CHECK(told.front() >= 0);
    CHECK(told.front() < 0.5);
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.back() == 1.0);
  }
}

}  // namespace far_limits_test
