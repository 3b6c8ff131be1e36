// SPDX-License-Identifier: BSD-3-Clause
// Peaks of what lasts less than a step, or begins where a step was cut.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/path/path_run.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace short_peaks_test {

namespace {

constexpr double g = 9.81, free_length = 1.3, tip = 2, arm = 1;

// An arm of 1 m falls from level into a cable from a point 1 m above its tip.
std::string caught(double stiffness) {
  return R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 2},
         {name = "P", position = [1, 0, 1], fixed = true}]
rods = [{name = "arm", nodes = ["A", "B"], mass = 1}]
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "spring"
name = "cable"
nodes = ["P", "B"]
free_length = 1.3
tension_only = true
stiffness = )" +
         std::to_string(stiffness) + "\n[solver]\nend_time = 0.4\nstep = 0.01\nstages = 7\n";
}

// Where the arm stands still in the cable all its energy is in it: with the angle a below the level,
// k/2 (s(a) - s_0)^2 = (M + m/2) g sin a.
double most_pull(double stiffness) {
  const auto stretch = [](double a) { return std::hypot(1 - std::cos(a), 1 + std::sin(a)) - free_length; };
  double low = 0.1, high = 1.2;
  for (int it = 0; it < 200; ++it) {
    const double a = 0.5 * (low + high), e = std::max(stretch(a), 0.0);
    (0.5 * stiffness * e * e < (tip + 0.5 * arm) * g * std::sin(a) ? low : high) = a;
  }
  return stiffness * stretch(low);
}

// A crank of 2 kg m^2 that a drive turns from 180 degrees.
Simulation kicked(double to, double start, double duration) {
  return testing::run_scene(
      R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1},
         {name = "C", position = [-1, 0, 0], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 3}, {nodes = ["A", "C"], mass = 1}]
[[structure.constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
name = "kick"
nodes = ["B", "A", "C"]
axis = [0, 1, 0]
motion = "smooth"
[solver]
end_time = 0.3
stages = 4
)",
      {"constraints[kick].to=" + std::to_string(to), "constraints[kick].start=" + std::to_string(start),
       "constraints[kick].duration=" + std::to_string(duration)});
}

}  // namespace

// The cable pulls for 16 ms to 0.5 ms; steps take 10. The top of a parabola through three of 73 points of
// half a sine is within 1e-6 of it; where the rest of a step is one of its sides, within 1e-4.
TEST_CASE("the peak of a contact that is shorter than a step is found") {
  for (const double stiffness : {1e5, 1e6, 1e7, 1e8}) {
    const auto model = testing::model_of(caught(stiffness));
    const Simulation run = simulate_on_path(model, read_scene_text(caught(stiffness), "s.toml").solver);
    REQUIRE(run.events.size() >= 2);
    CHECK(largest_of_column(run, diagnose(run), "P.reaction_N") ==
          Approx(most_pull(stiffness)).epsilon(1e-4));
  }
}

// The full model takes 10 ms steps through a contact of 1.6 ms, which is no answer, and says so; it has one
// of 50 ms.
TEST_CASE("a contact that steps do not resolve is warned of") {
  for (const auto& [stiffness, warned] : {std::pair{1e7, true}, {1e3, false}}) {
    const Simulation run = testing::run_scene(caught(stiffness));
    const bool told = std::ranges::any_of(run.warnings, [](const std::string& w) {
      return w.starts_with("what cable holds swings on it in ");
    });
    CHECK(told == warned);
  }
}

// A bob of 1 kg on a rod, held by a winch's cable of 5000 N: it swings on it in 76 ms. Steps of 1/35 s are
// more than a quarter of that, and with four stages right to 1e-9 m against short steps of five.
TEST_CASE("more stages follow in a step what fewer would not, and are not warned of") {
  const std::string winch = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "X", position = [0, 0, 1], fixed = true},
         {name = "bob", position = [0.6, 0, -0.8], mass = 1}]
rods = [{nodes = ["O", "bob"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["bob"]
normal = [0, 1, 0]
[[forces]]
kind = "winch"
name = "w"
nodes = ["X", "bob"]
stall_torque = 2
no_load_speed = 3000
drum_radius = 0.05
inertia = 1e-3
axial_stiffness = 5000
damping = 20
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 1
step = 0.0285714285714285714
)";
  const auto warned = [](const Simulation& run) {
    return std::ranges::any_of(run.warnings, [](const std::string& w) {
      return w.starts_with("what w cable holds swings on it in ");
    });
  };
  const auto bob = [](const Simulation& run) { return VectorXd(testing::end_positions(run).segment<3>(6)); };
  const Simulation exact = testing::run_scene(winch, {"solver.stages=5", "solver.step=0.002"}),
                   four = testing::run_scene(winch, {"solver.stages=4"}),
                   three = testing::run_scene(winch, {"solver.stages=3"});
  CHECK((bob(four) - bob(exact)).norm() < 1e-9);
  CHECK_FALSE(warned(four));
  CHECK(warned(three));
  CHECK(warned(testing::run_scene(winch, {"solver.method=rk4", "solver.stages=4", "solver.end_time=0.1"})));
}

// s = 10 u^3 - 15 u^4 + 6 u^5 of one degree in 40 ms, four steps: the inertia of 2 kg m^2 takes
// P = 2 a^2 s' s'' / T^3, equal to the last digit at the states on both sides of the middle, and none of its
// peaks is at a state.
TEST_CASE("a peak between states of one value is found") {
  double most = 0;
  for (int k = 0; k <= 100000; ++k) {
    const double u = k * 1e-5;
    most = std::max(most, 30 * u * u * (1 - u) * (1 - u) * (60 * u - 180 * u * u + 120 * u * u * u));
  }
  const double a = pi / 180, T = 0.04;
  for (const double start : {0.1, 0.05, 0.11, 0.12, 0.13, 0.07})
    for (const double to : {181, 179}) {
      const Simulation run = kicked(to, start, T);
      const Diagnostics d = diagnose(run);
      CHECK(largest_of_column(run, d, "kick.power_W") ==
            Approx(2 * a * a * most / (T * T * T)).epsilon(2e-3));
      CHECK(smallest_of_column(run, d, "kick.power_W") ==
            Approx(-2 * a * a * most / (T * T * T)).epsilon(2e-3));
    }
}

// A drive that lasts 4 ms, of steps of 10: 67 J go in and come back between two of them, and round-off of 67
// J is no error.
TEST_CASE("a drive that begins and ends within a step is no energy out of nothing") {
  const Simulation run = kicked(181, 0.103, 0.004);
  const Diagnostics d = diagnose(run);
  CHECK(mistrust(run, d) == "");
  // K at its peak, in the middle: 1/2 2 (1.875 a / T)^2.
  const double rate = 1.875 * (pi / 180) / 0.004;
  CHECK(largest_of_column(run, d, "kinetic_energy_J") == Approx(rate * rate).epsilon(1e-6));
}

// Two rods hang with 2 + 3 t and 5 - 2 t; the point of one bears its rod's force and a load against that, 2 +
// 3 t
// - 3.1 upwards and c across: of the least of the rods' forces the most is 3.8 N, at 0.6 s, and the least of
// the reaction c, at 0.3667 s, no state of either. Where the two cross, or c is nothing, values have a
// corner, which no parabola through states leads to.
TEST_CASE("the extremes of values with corners are those of the motion") {
  for (const char* across : {"0", "1e-3", "0.1", "1"})
    for (const char* step : {"0.07", "0.045", "0.013", "0.11"}) {
      INFO(across << " N, " << step << " s");
      const Simulation run = testing::run_scene(
          R"(
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "C", position = [0, 0, -1], mass = 1},
         {name = "Q", position = [1, 0, 0], fixed = true}, {name = "D", position = [1, 0, -1], mass = 1}]
rods = [{nodes = ["P", "C"], mass = 1}, {nodes = ["Q", "D"], mass = 1}]
[[loads]]
nodes = ["P"]
force = [0, 0, 3.1]
[[loads]]
nodes = ["P"]
force = [1, 0, 0]
[[forces]]
kind = "load_over_time"
nodes = ["C"]
force = [0, 0, -1]
times = [0, 2]
values = [2, 8]
[[forces]]
kind = "load_over_time"
nodes = ["D"]
force = [0, 0, -1]
times = [0, 2]
values = [5, 1]
[solver]
end_time = 2
)",
          {std::string("solver.step=") + step, std::string("loads[1].force=[") + across + ",0,0]"});
      const Diagnostics d = diagnose(run);
      CHECK(largest_of_column(run, d, "axial_force_min_N") == Approx(3.8).epsilon(1e-12));
      // Hyperbolas that are narrower than a sixteenth of a step are corners; of the others parabolas of 9
      // points.
      CHECK(smallest_of_column(run, d, "P.reaction_N") ==
            Approx(std::stod(across)).epsilon(1e-3).margin(1e-12));
    }
}

// A bob hangs on a clearance pin below a cable over a slider, whose friction on it turns round beside the
// peak: a polynomial through the states there swings. What is told must be the force at the time that is
// told.
TEST_CASE("a peak is the force of the motion at its time") {
  const std::string slider = R"(
variables = {x = 0.24298444666592509, z = -0.9823963348254381, u = 0.6362824357890278}
[structure]
kind = "custom"
nodes = [{name = "P", position = [0, 0, 0], fixed = true}, {name = "Q", position = ["=x", 0, "=z"], mass = 0.97},
  {name = "S", position = ["=u*x", 0, "=u*z"], mass = 1.32}, {name = "C", position = ["=u*x", 0, "=u*z"], mass = 0.4},
  {name = "D", position = ["=u*x+0.34", 0, "=u*z-0.4"], mass = 0.6}]
rods = [{nodes = ["P", "Q"], mass = 1.2}, {nodes = ["C", "D"], mass = 0.2}]
constraints = [{kind = "collinear", nodes = ["P", "Q", "S"]},
               {kind = "plane", nodes = ["Q", "C", "D"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "cable"
nodes = ["P", "S", "D"]
axial_stiffness = 575.4
length = 1.065
damping = 2
pulley_friction = 0.12
[[constraints]]
kind = "clearance"
nodes = ["S", "C"]
clearance = 0.01
[solver]
end_time = 0.5
stages = 4
)";
  for (int k = 0; k < 29; ++k) {
    const double step = 0.0009 + 0.000025 * k;
    INFO(step);
    const Simulation run = testing::run_scene(slider, {"solver.step=" + std::to_string(step)});
    const PeakInMotion peak = extreme_of_column(run, diagnose(run), "axial_force_min_N", false);
    const VectorXd there = rod_forces_within_step(run, peak.t);
    REQUIRE(there.size() == 2);
    CHECK(there.minCoeff() == Approx(peak.value).epsilon(1e-4));
  }
}

// A pendulum of 1 kg that swings down from 60 degrees pulls with 2 m g at its lowest, at no state; beside it
// one hangs that weighs 0.05 N less than that, and more than the first has at any state.
TEST_CASE("a rod that tops another one within a step only is the one of the peak") {
  for (const double step : {0.1, 0.08, 0.05}) {
    INFO(step);
    const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "E", position = [5, 0, 0], fixed = true}, {name = "F", position = [5, 0, -1], mass = "=2 - 0.05/9.81"},
         {name = "A", position = [0, 0, 0], fixed = true},
         {name = "B", position = [0.8660254037844386, 0, -0.5], mass = 1}]
rods = [{name = "Q", nodes = ["E", "F"], mass = 0}, {name = "R", nodes = ["A", "B"], mass = 0}]
constraints = [{kind = "plane", nodes = ["B", "F"], normal = [0, 1, 0]}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
end_time = 1
step = )" + std::to_string(step) + "\n");
    REQUIRE(run.status == RunStatus::completed);
    const Diagnostics d = diagnose(run);
    const PeakForce peak = peak_rod_force(run, d);
    CHECK(peak.rod == 1);
    CHECK(peak.force_N == Approx(2 * g).epsilon(1e-6));
    CHECK(largest_of_column(run, d, "axial_force_max_N") == Approx(2 * g).epsilon(1e-6));
  }
}

}  // namespace short_peaks_test
