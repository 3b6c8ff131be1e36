// SPDX-License-Identifier: BSD-3-Clause
// The deployed pose within a step: what is led there or past it, what else happens in that step.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/measured_event.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace deployed_pose_test {

namespace {

using testing::number, testing::run_scene;

double time_of(const Simulation& run, const std::string& name) {
  const auto event = std::ranges::find(run.events, name, &Event::name);
  return event == run.events.end() ? -1 : event->t;
}

// The share of its time after which a smooth motion, u^3 (10 - 15 u + 6 u^2), has made that part of its way.
double smooth_share(double part) {
  double a = 0, b = 1;
  for (int k = 0; k < 60; ++k) {
    const double u = 0.5 * (a + b);
    (u * u * u * (10 - 15 * u + 6 * u * u) < part ? a : b) = u;
  }
  return 0.5 * (a + b);
}

}  // namespace

// A crank that rests 20 to 60 degrees behind its deployed pose, which its last step passes.
TEST_CASE("a drive that comes to rest behind the deployed pose has deployed on the way there") {
  const std::string crank = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "G", position = [1, 0, 0], fixed = true},
         {name = "B", position = [1, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
name = "d"
nodes = ["G", "A", "B"]
axis = [0, 1, 0]
motion = "smooth"
to = 90
duration = 0.7
[deployment]
measure = "angle G A B about 0 1 0"
[solver]
end_time = 1
)";
  for (const double deployed : {30.0, 47.3, 70.0})
    for (const double step : {0.7, 0.35, 0.233})
      for (const char* then : {"stop", "pass"}) {
        INFO(deployed << " " << step << " " << then);
        const Simulation run =
            run_scene(crank, {"deployment.deployed=" + number(deployed), "solver.step=" + number(step),
                              std::string("solver.at_deployed=") + then});
        CHECK(time_of(run, "deployed") == Approx(0.7 * smooth_share(deployed / 90)).epsilon(0).margin(1e-9));
      }
}

// A ring loses rank in its deployed pose.
TEST_CASE("a ring is led into its deployed pose on time and at the rate of its drive") {
  const std::string ring = R"(
[structure]
kind = "hoop"
fold_angle = 40
hinge_force = 0
[[constraints]]
kind = "angle"
fold_angle = true
)";
  const auto rate_at_end = [](const Simulation& run) {
    return remaining_rate(run.trajectory.last_model(), run.trajectory.state(run.trajectory.size() - 1));
  };
  for (const double step : {0.05, 0.037}) {
    const Simulation rests =
        run_scene(ring + "motion = 'smooth'\nto = 0\nduration = 1.3\n", {"solver.step=" + number(step)});
    INFO(step << " s");
    REQUIRE(rests.status == RunStatus::deployed);
    CHECK(time_of(rests, "deployed") == Approx(1.3).epsilon(0).margin(1e-12));
    CHECK(std::abs(rate_at_end(rests)) <= 1e-9);
    // With and without a ramp that ends as the pose is reached, after 40 degrees at half the rate.
    for (const double ramp : {0.0, 3.2}) {
      const Simulation passes = run_scene(ring + "motion = 'rate'\nrate = -25\nramp = " + number(ramp),
                                          {"solver.step=" + number(step)});
      INFO("ramp " << ramp);
      REQUIRE(passes.status == RunStatus::deployed);
      CHECK(time_of(passes, "deployed") == Approx(1.6 + 0.5 * ramp).epsilon(0).margin(1e-9));
      CHECK(rate_at_end(passes) == Approx(-25 * pi / 180).epsilon(1e-8));
    }
  }
}

// A flies to its deployed place, 1.2 m on, at 1 m/s, B to its stop at 2 m/s, from which it leaves at 1 m/s.
TEST_CASE("what strikes a stop in the step of the deployed pose does so in its order") {
  const std::string flying = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 2},
         {name = "B", position = [0, 1, 0], velocity = [2, 0, 0], mass = 3}]
[[constraints]]
kind = "coordinate_stop"
name = "wall"
nodes = ["B"]
direction = [1, 0, 0]
max = 2.3
restitution = 0.5
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 1.2
[solver]
step = 0.13
end_time = 2
at_deployed = "pass"
)";
  for (const double wall : {2.35, 2.38, 2.42, 2.46, 2.59}) {  // the step is from 1.17 s to 1.30 s
    const Simulation run = run_scene(flying, {"constraints[0].max=" + number(wall)});
    INFO(wall << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(time_of(run, "deployed") == Approx(1.2).epsilon(0).margin(1e-9));
    REQUIRE(run.events.size() == 2);
    const Event& strikes = run.events[wall < 2.4 ? 0 : 1];
    CHECK(strikes.name == "stop wall");
    CHECK(strikes.t == Approx(0.5 * wall).epsilon(0).margin(1e-9));
    const VectorXd end = testing::end_positions(run);
    CHECK(end[0] == Approx(2).epsilon(0).margin(1e-9));
    CHECK(end[3] == Approx(wall - (2 - 0.5 * wall)).epsilon(0).margin(1e-9));
  }
}

// B follows A on a taut rope; A is latched after 1.2 m.
TEST_CASE("a rope that a latch lets go is told of") {
  const std::string towed = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [1, 0, 0], mass = 2},
         {name = "B", position = [-0.7, 0, 0], velocity = [1, 0, 0], mass = 3}]
[[constraints]]
kind = "line"
nodes = ["A", "B"]
direction = [1, 0, 0]
[[constraints]]
kind = "cable"
name = "rope"
nodes = ["A", "B"]
[[loads]]
nodes = ["A"]
force = [10, 0, 0]
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 1.2
[solver]
step = 0.13
end_time = 1.1
at_deployed = "latch"
)";
  // 5 kg pulled by 10 N from 1 m/s: t + t^2 = 1.2; B flies on alone, at 1 + 2 t.
  const double t = 0.5 * (std::sqrt(1 + 4 * 1.2) - 1);
  const Simulation run = run_scene(towed);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(time_of(run, "latched") == Approx(t).epsilon(0).margin(1e-9));
  CHECK(time_of(run, "rope is slack") == Approx(t).epsilon(0).margin(1e-9));
  CHECK(testing::end_positions(run)[3] == Approx(0.5 + (1 + 2 * t) * (1.1 - t)).epsilon(0).margin(1e-9));
}

// A spring that its damper alone keeps slack, at 0.5 (10 - 50 t) - 50 N and less, while A flies back at 1
// m/s, pulls as soon as a latch holds A.
TEST_CASE("a spring that pulls from the moment of a latch on is told of") {
  const std::string flying = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1.5, 0, 0], velocity = [-1, 0, 0], mass = 2}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
name = "rope"
nodes = ["O", "A"]
stiffness = 10
damping = 50
free_length = 1
tension_only = true
[deployment]
measure = "coordinate A along 1 0 0"
deployed = 1.2
[solver]
step = 0.13
end_time = 1
at_deployed = "latch"
)";
  const Simulation run = run_scene(flying);
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(time_of(run, "latched") == Approx(0.3).epsilon(0).margin(1e-9));
  CHECK(time_of(run, "rope pulls") == Approx(0.3).epsilon(0).margin(1e-9));
  const Diagnostics d = diagnose(run);
  CHECK(d.at("potential_energy_J").values.back() == Approx(0.5 * 10 * 0.2 * 0.2).epsilon(0).margin(1e-9));
}

// A bob of 1 m, let go from the horizontal, is deployed just above its lowest point, in whatever part of a
// step.
TEST_CASE("a deployed pose that is met and left again is seen wherever in a step") {
  const std::string swing = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 2}]
rods = [{nodes = ["A", "B"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "1 coordinate B along 0 0 1"
deployed = -0.999999
[solver]
stages = 6
end_time = 1
)";
  // t = int_0^f df / sqrt(2 g sin f) with f = u^2, by Simpson's rule.
  const double end = std::sqrt(std::asin(0.999999));
  const auto f = [](double u) { return 2 * u / std::sqrt(2 * 9.81 * std::sin(u * u)); };
  constexpr int n = 4000;
  double t = std::sqrt(2 / 9.81) + f(end);
  for (int k = 1; k < n; ++k) t += (k % 2 ? 4 : 2) * f(end * k / n);
  t *= end / n / 3;
  for (const double share : {0.02, 0.07, 0.13, 0.31, 0.52, 0.77, 0.91, 0.95, 0.98}) {
    INFO(share << " of a step");
    // Order 12 in steps of 0.1 s; the rate there is 1.4e-3 of the speed.
    const Simulation run = run_scene(swing, {"solver.step=" + number(t / (5 + share))});
    CHECK(time_of(run, "deployed") == Approx(t).epsilon(0).margin(1e-6));
  }
}

}  // namespace deployed_pose_test
