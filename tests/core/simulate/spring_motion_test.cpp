// SPDX-License-Identifier: BSD-3-Clause
// Springs, dampers and loads over time against closed forms, with every energy accounted for.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace spring_motion_test {

namespace {

using testing::end_positions, testing::run_scene;

double largest(const Simulation& run, const char* column) {
  return testing::largest(diagnose(run), column);
}

// A mass of 2 kg on the x axis, 1.5 m from its anchor, on a spring of 50 N/m and free length 1 m.
const std::string oscillator = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1.5, 0, 0], mass = 2}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 50
free_length = 1
damping = 0
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[solver]
stages = 4
step = 0.02
end_time = 2
)";

double x_at(const Simulation& run, std::size_t i) {
  return run.trajectory.positions(i)[3];
}

// A rod of 3 kg and 2 m hinged to the ground beside a fixed arm, in the plane z = 0.
const std::string hinged_rod = R"(
[solver]
stages = 4
step = 0.01
end_time = 1
[structure]
kind = "custom"
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]}]
[[structure.nodes]]
name = "O"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "P"
position = [1, 0, 0]
fixed = true
[[structure.nodes]]
name = "A"
position = [0, 2, 0]
[[structure.rods]]
name = "arm"
nodes = ["O", "A"]
mass = 3
)";

}  // namespace

TEST_CASE("an oscillator swings as the cosine, with and without damping") {
  for (const double c : {0.0, 4.0, 30.0}) {  // free, weak, beyond critical (20)
    const Simulation run = run_scene(oscillator, {"forces[0].damping=" + std::to_string(c)});
    REQUIRE(run.status == RunStatus::completed);
    const double delta = c / 4, square = 25 - delta * delta, omega = std::sqrt(std::abs(square));
    for (std::size_t i = 0; i < run.trajectory.size(); i += 7) {
      const double t = run.trajectory.time(i);
      const double swing = square > 0 ? std::cos(omega * t) + delta / omega * std::sin(omega * t)
                                      : std::cosh(omega * t) + delta / omega * std::sinh(omega * t);
      // Order 6: (5 * 0.02)^6 = 1e-6 times a small constant; the largest seen is 1e-10.
      CHECK(x_at(run, i) == Approx(1 + 0.5 * std::exp(-delta * t) * swing).epsilon(0).margin(2e-9));
    }
    // Of 6.25 J; the quadrature of order 6 sees decays of up to 27 / s: (27 * 0.02)^6 / 7! of the power.
    CHECK(largest(run, "energy_balance_J") <= 1e-7);
    if (c > 0)
      CHECK(largest(run, "dissipated_J") == Approx(6.25 - diagnose(run).at("kinetic_energy_J").values.back() -
                                                   diagnose(run).at("potential_energy_J").values.back())
                                                .margin(1e-7));
  }
}

TEST_CASE("velocity-dependent forces keep the order of the variational method") {
  const double delta = 1.0, omega = std::sqrt(24.0);
  for (const int stages : {2, 3, 4}) {
    const auto error = [&](double h) {
      const Simulation run = run_scene(oscillator, {"forces[0].damping=4", "solver.step=" + std::to_string(h),
                                                    "solver.stages=" + std::to_string(stages)});
      const double exact =
          1 + 0.5 * std::exp(-delta * 2) * (std::cos(omega * 2) + delta / omega * std::sin(omega * 2));
      return std::abs(x_at(run, run.trajectory.size() - 1) - exact);
    };
    CHECK(std::log2(error(0.1) / error(0.05)) == Approx(2 * stages - 2).epsilon(0).margin(0.3));
  }
}

TEST_CASE("a cable pulls and never pushes: half a swing, then free flight") {
  const Simulation run = run_scene(oscillator, {"forces[0].tension_only=true", "solver.step=0.001"});
  // Taut for a quarter period pi / 10, then 2.5 m/s towards the anchor, slack inside its free length.
  const double t = 0.5, flight = 1 - 2.5 * (t - pi / 10);
  // Second order in the one step of 1 ms in which the cable slackens.
  std::size_t at = 0;  // states at the switches of the cable stand between those of the grid
  while (run.trajectory.time(at) < t - 1e-9) ++at;
  REQUIRE(run.trajectory.time(at) == Approx(t).epsilon(1e-12));
  CHECK(x_at(run, at) == Approx(flight).epsilon(0).margin(1e-5));
  CHECK(largest(run, "energy_balance_J") <= 1e-4);
}

TEST_CASE("a load over time gives the momentum of its integral, and its work is booked") {
  const Simulation run = run_scene(
      hinged_rod, {"structure.rods[0].mass=0", "structure.nodes.A.mass=2", "structure.nodes.O.fixed=false",
                   "structure.nodes.O.mass=1e-9", "solver.end_time=1"});
  CHECK(run.status == RunStatus::completed);
  const Simulation pushed = run_scene(oscillator + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [10, 0, 0]
times = [0, 1, 2]
values = [0, 1, 0]
)",
                                      {"forces[0].stiffness=0"});
  // A triangle of 10 N and 2 s: 10 N s on 2 kg. Its corners lie on steps; inside them it is a line.
  CHECK(pushed.trajectory.velocities(pushed.trajectory.size() - 1)[3] == Approx(5).epsilon(1e-12));
  CHECK(diagnose(pushed).at("work_J").values.back() == Approx(25).epsilon(1e-10));
  CHECK(largest(pushed, "energy_balance_J") <= 1e-10);
}

TEST_CASE("a follower keeps its torque about the hinge: uniform angular acceleration") {
  const std::string push = R"(
[[structure.nodes]]
name = "T"
position = [-1, 2, 0]
mass = 1e-3
[[structure.rods]]
name = "nozzle"
nodes = ["T", "A"]
mass = 0
[[constraints]]
kind = "angle"
nodes = ["O", "A", "T"]
axis = [0, 0, 1]
[[constraints]]
kind = "plane"
nodes = ["T"]
normal = [0, 0, 1]
[[forces]]
kind = "follower"
rod = "nozzle"
force = 6
)";
  const Simulation run = run_scene(hinged_rod + push);
  REQUIRE(run.status == RunStatus::completed);
  // Inertia m l^2 / 3 = 4 and 1e-3 * 5, torque 6 N * 2 m clockwise: turned by alpha t^2 / 2.
  const double turned = 0.5 * 12.0 / 4.005;
  const VectorXd x = end_positions(run);
  CHECK(std::atan2(x[6], x[7]) == Approx(turned).epsilon(1e-9));
  CHECK(largest(run, "energy_balance_J") <= 1e-8);
  CHECK(diagnose(run).at("work_J").values.back() == Approx(12.0 * turned).epsilon(1e-8));
}

TEST_CASE("a torsion spring drives a rod as its energy integral says") {
  const std::string spring = R"(
[[forces]]
kind = "torsion_spring"
nodes = ["P", "O", "A"]
stiffness = 8
free_angle = 170
axis = [0, 0, 1]
damping = 0
)";
  // I theta'' = -k (theta - theta_0): a cosine from 90 degrees about 170 degrees, omega = sqrt(8 / 4).
  const Simulation run = run_scene(hinged_rod + spring);
  const VectorXd x = end_positions(run);
  const double theta = (170 - 80 * std::cos(std::sqrt(2.0))) * radians_per_degree;
  CHECK(std::atan2(x[7], x[6]) == Approx(theta).epsilon(1e-9));
  CHECK(largest(run, "energy_balance_J") <= 1e-9);
  // Damped at a rate beyond which it would swing, with joint_damping against the ground arm as well.
  const Simulation damped = run_scene(hinged_rod + spring, {"forces[0].damping=3"});
  CHECK(largest(damped, "energy_balance_J") <= 1e-9);
  CHECK(diagnose(damped).at("dissipated_J").values.back() > 1.0);
}

TEST_CASE("stiff springs are solved with the full Newton matrix") {
  // h omega = 0.02 * 5000 = 100: far beyond what a fixed-point iteration takes.
  const Simulation run = run_scene(
      oscillator,
      {"forces[0].stiffness=5e7", "structure.nodes.A.position=[1.0001, 0, 0]", "solver.end_time=0.2"});
  CHECK(run.status == RunStatus::completed);
}

}  // namespace spring_motion_test
