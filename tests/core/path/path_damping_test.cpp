// SPDX-License-Identifier: BSD-3-Clause
// What dampers take of a run on the path, where they stop rates within a step.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/path/path_run.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace path_damping_test {

// A rod let go where it is level, its tip dragged: it sinks at the rate (3/2) m g / (3 c) after m / (3 c) s.
// Dissipated is what gravity has done, m g / 2 of the tip's way down, less the kinetic energy m v^2 / 6.
TEST_CASE("dissipated energy is right where a damper is stiff at the step") {
  constexpr double m = 3, g = 10;
  for (const double c : {3.0, 30.0, 100.0, 300.0, 1000.0, 1e4, 1e6})
    for (const double step : {0.01, 0.002}) {
      CAPTURE(c, step);
      const Scene scene =
          read_scene_text(R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 3}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -10]
[[forces]]
kind = "drag"
nodes = ["B"]
damping = 1
[solver]
end_time = 0.5
)toml",
                          "s.toml", {"forces[0].damping=" + number(c), "solver.step=" + number(step)});
      Simulation run = simulate_on_path(build_model(scene), scene.solver);
      const Diagnostics d = judge(run);
      const std::size_t last = run.trajectory.size() - 1;
      const double z = run.trajectory.node_positions(last)[5],
                   speed = run.trajectory.node_velocities(last).tail<3>().norm();
      const double taken = -0.5 * m * g * z - m * speed * speed / 6;
      // Of what falls like e^(-3 c t / m) a few thousandths are left to the second step at 3 c h / m = 3,
      // some of them to a rule of order 4.
      CHECK(d.at("dissipated_J").values.back() == Approx(taken).epsilon(1e-4));
      CHECK(accuracy_warnings(run, d).empty());
    }
}

// n times the no-load speed comes about within I / (n^2 stall / speed), 10^-4 to 10 of the step. From -90
// degrees on the arm turns at w0 / n; the work of the motor is its kinetic energy and what gravity asks, here
// none.
TEST_CASE("books close where the speed line of a geared motor is stiff at the step") {
  constexpr double inertia = 0.5 / 3 + 1, stall = 0.1, speed = 18000 * 2 * pi / 360;
  for (const double gear : {500.0, 1000.0, 1500.0, 3000.0, 3e4, 1e6}) {
    CAPTURE(gear);
    const Scene scene = read_scene_text(R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0], mass = 1},
  {name = "G", position = [0, 0, 1], fixed = true}]
rods = [{nodes = ["O", "A"], mass = 0.5}]
[[forces]]
kind = "motor"
name = "m"
nodes = ["A", "O", "G"]
axis = [0, 1, 0]
stall_torque = 0.1
no_load_speed = 18000
gear_ratio = -1
[[constraints]]
kind = "plane"
nodes = ["A"]
normal = [0, 1, 0]
[solver]
end_time = 0.2
)toml",
                                        "s.toml", {"forces[0].gear_ratio=-" + number(gear)});
    Simulation run = simulate_on_path(build_model(scene), scene.solver);
    const Diagnostics d = judge(run);
    CHECK(accuracy_warnings(run, d).empty());
    const double rate = gear * gear * stall / speed / inertia, w = speed / gear * (1 - std::exp(-0.2 * rate));
    CHECK(d.at("work_J").values.back() == Approx(0.5 * inertia * w * w).epsilon(1e-3));
    CHECK(run.trajectory.node_velocities(run.trajectory.size() - 1).norm() == Approx(w).epsilon(1e-9));
  }
}

namespace {

struct Springs {
  double F, c, end;
};

// 1 kg on a line between two springs that pull at it with F each along the line, dampers beside them, at 0.3
// m/s from their balance: RK4.
double speed_between(const Springs& with) {
  constexpr int n = 80000;
  const double la0 = std::sqrt(1.09), lb0 = std::hypot(1.3, 0.7), h = with.end / n;
  const double ka = with.F / (la0 - 0.5) * la0, kb = with.F / (lb0 - 0.5) * lb0 / 1.3;
  const auto a = [&](double x, double v) {
    const double la = std::hypot(x + 1, 0.3), lb = std::hypot(x - 1.3, 0.7);
    const double na = (x + 1) / la, nb = (x - 1.3) / lb;
    return -(ka * (la - 0.5) + with.c * v * na) * na - (kb * (lb - 0.5) + with.c * v * nb) * nb;
  };
  double x = 0, v = 0.3;
  for (int i = 0; i < n; ++i) {
    const double a1 = a(x, v), v2 = v + 0.5 * h * a1, a2 = a(x + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
    const double a3 = a(x + 0.5 * h * v2, v3), v4 = v + h * a3, a4 = a(x + h * v3, v4);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return v;
}

}  // namespace

// Where large forces balance what is left of them is rounding, and no measure of a speed.
TEST_CASE("dampers are known as well where springs balance each other") {
  for (const Springs& with : {Springs{10, 0.1, 1},
                              {30, 0.01, 1},
                              {1000, 0, 1},
                              {1000, 0.1, 1},
                              {1000, 1, 1},
                              {1e4, 1, 0.05},
                              {1e6, 1e3, 0.01},
                              {1e6, 1e3, 1}}) {
    CAPTURE(with.F, with.c);
    const Scene scene = read_scene_text(
        R"toml(
[variables]
F = 1
c = 1
[structure]
kind = "custom"
nodes = [{name = "A", position = [-1, 0.3, 0], fixed = true}, {name = "B", position = [1.3, 0.7, 0], fixed = true},
  {name = "P", position = [0, 0, 0], mass = 1, velocity = [0.3, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["A", "P"]
stiffness = "=F/(sqrt(1.09)-0.5)*sqrt(1.09)"
damping = "=c"
free_length = 0.5
[[forces]]
kind = "spring"
nodes = ["B", "P"]
stiffness = "=F/(sqrt(1.3^2+0.49)-0.5)*sqrt(1.3^2+0.49)/1.3"
damping = "=c"
free_length = 0.5
[solver]
step = 0.01
)toml",
        "s.toml",
        {"variables.F=" + number(with.F), "variables.c=" + number(with.c),
         "solver.end_time=" + number(with.end)});
    const Simulation run = simulate_on_path(build_model(scene), scene.solver);
    // Of 0.3 m/s: rounding of F, of 1e-16 F each, over 1 kg, and 3e-12 of the order 4 at 60 rad/s.
    const double v = run.trajectory.node_velocities(run.trajectory.size() - 1)[6];
    CHECK(v == Approx(speed_between(with)).margin(2e-12).epsilon(0));
    // As few steps as the swing asks for, not what noise does.
    CHECK(run.trajectory.size() <= 400);
  }
}

}  // namespace path_damping_test
