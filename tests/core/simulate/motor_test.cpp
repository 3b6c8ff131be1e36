// SPDX-License-Identifier: BSD-3-Clause
// Motors against closed forms: torque-speed line, gear, rotor, current limit, controllers, winch.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/measures.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace motor_test {

namespace {

using testing::end_positions, testing::error_of, testing::model_of, testing::run_scene;

// A crank of inertia 0.7 * 0.5^2 = 0.175 kg m^2 about z, no gravity.
const std::string crank = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true}, {name = "E", position = [1, 0, 0], fixed = true},
  {name = "T", position = [0.3, 0.4, 0], mass = 0.7}]
rods = [{nodes = ["O", "T"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["T"]
normal = [0, 0, 1]
[[forces]]
kind = "motor"
name = "motor"
nodes = ["E", "O", "T"]
axis = [0, 0, 1]
stall_torque = 0.03
no_load_speed = 3000
gear_ratio = 20
[solver]
stages = 5
step = 0.02
end_time = 1.5
)";

constexpr double inertia = 0.175, stall = 0.03, ratio = 20;
const double no_load = 3000 * pi / 180, start_angle = std::atan2(0.4, 0.3);

double last_of(const Diagnostics& d, const char* column) {
  return d.at(column).values.back();
}

}  // namespace

// I th'' = n T_0 (1 - n th' / w_0): th' = W (1 - exp(-t / tau)), W = w_0 / n, tau = I W / (n T_0); a rotor
// adds n^2 J to I.
TEST_CASE("a motor runs up along its torque-speed line, with its rotor behind the gear") {
  for (const double rotor : {0.0, 6e-4}) {
    const Simulation run = run_scene(crank, {"forces[0].inertia=" + std::to_string(rotor)});
    REQUIRE(run.status == RunStatus::completed);
    const double all = inertia + ratio * ratio * rotor, top = no_load / ratio,
                 tau = all * top / (ratio * stall);
    const double t = 1.5, rate = top * (1 - std::exp(-t / tau));
    const double angle = start_angle + top * (t - tau * (1 - std::exp(-t / tau)));
    const Diagnostics d = diagnose(run);
    // Order 8 at h / tau = 0.02 / 0.76 and angles of 0.05 rad a step.
    CHECK(last_of(d, "motor.angle_rad") == Approx(angle).epsilon(0).margin(1e-10));
    CHECK(last_of(d, "motor.torque_N_m") == Approx(ratio * stall * (1 - rate / top)).epsilon(0).margin(1e-9));
    CHECK(last_of(d, "motor.power_W") ==
          Approx(ratio * stall * (1 - rate / top) * rate).epsilon(0).margin(1e-9));
    CHECK(last_of(d, "motor.energy_J") == Approx(0.5 * all * rate * rate).epsilon(0).margin(1e-9));
    CHECK(testing::largest(d, "energy_balance_J") <= 1e-9);
  }
}

// 0.5 m/s at 0.5 m: 1 rad/s, which the rotor has as well, else it would take most of it at the start.
TEST_CASE("a joint that turns at the start keeps its rate, whatever its motor's rotor weighs") {
  const Simulation run =
      run_scene(crank, {"forces[0].inertia=6e-4", "structure.nodes.T.velocity=[-0.4,0.3,0]"});
  CHECK(run.warnings.empty());
  // All of it turns as one rigid body.
  CHECK(diagnose(run).at("kinetic_energy_J").values.front() ==
        Approx(0.5 * (inertia + ratio * ratio * 6e-4)).epsilon(1e-12));
}

TEST_CASE("a motor's rotor is its own, whatever other forces stand before and behind it") {
  // A spring between what is fixed does nothing.
  const std::string idle =
      "[[forces]]\nkind = \"spring\"\nname = \"idle\"\nnodes = [\"O\", \"E\"]\nstiffness = 3\n";
  std::string text = crank;
  text.insert(text.find("[[forces]]"), idle);
  text.insert(text.find("[solver]"),
              idle.substr(0, idle.find("idle")) + "behind" + idle.substr(idle.find("idle") + 4));
  const double rotor = 6e-4, all = inertia + ratio * ratio * rotor, top = no_load / ratio,
               tau = all * top / (ratio * stall);
  const Simulation run = run_scene(text, {"forces[1].inertia=" + std::to_string(rotor)});
  REQUIRE(run.status == RunStatus::completed);
  CHECK(last_of(diagnose(run), "motor.angle_rad") ==
        Approx(start_angle + top * (1.5 - tau * (1 - std::exp(-1.5 / tau)))).epsilon(0).margin(1e-10));
}

TEST_CASE("a motor gives no more than its current allows") {
  const Simulation run = run_scene(
      crank, {"forces[0].current_limit=2", "forces[0].torque_constant=0.005", "solver.end_time=0.5"});
  // T = 0.01 N m while the line gives more, up to n th' = 2/3 w_0, which is later.
  const double angle = start_angle + 0.5 * ratio * 0.01 / inertia * 0.25;
  CHECK(last_of(diagnose(run), "motor.angle_rad") == Approx(angle).epsilon(0).margin(1e-11));
}

// Each part of a motor's law is smooth; where one gives way to the next is the end of a step, for every
// method and whatever the steps are.
//
//     limit    I th'' = n L while n L < n T_0 (1 - n th' / w_0); then along the line, th' = W - (W - W_1)
//     exp(-t / tau)
TEST_CASE("a motor leaves its current limit at the right time by every method") {
  const double limit = 0.018, t = 1.5, top = no_load / ratio, tau = inertia * top / (ratio * stall);
  const double rate1 = top * (1 - limit / stall), t1 = rate1 * inertia / (ratio * limit), rest = t - t1;
  const double angle =
      start_angle + 0.5 * rate1 * t1 + top * rest - (top - rate1) * tau * (1 - std::exp(-rest / tau));
  REQUIRE(t1 < 1.2);
  // dvm: order 8 at h / tau = 0.02 / 0.76; rk4: (h / tau)^5 / 120 a step of 4 ms, times 375 steps.
  struct Case {
    const char* method;
    double step, error;
  };
  for (const Case& c :
       {Case{"dvm", 0.037, 1e-10}, Case{"rk4", 0.0041, 1e-9}, Case{"rk4_projected", 0.0041, 1e-9}}) {
    const Simulation run =
        run_scene(crank, {"forces[0].current_limit=3.6", "forces[0].torque_constant=0.005",
                          std::string("solver.method=") + c.method, "solver.step=" + std::to_string(c.step)});
    INFO(c.method);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].name == "motor runs below its current limit");
    CHECK(run.events[0].kind == "unsaturated");
    CHECK(run.events[0].t == Approx(t1).epsilon(0).margin(c.error));
    CHECK(last_of(diagnose(run), "motor.angle_rad") == Approx(angle).epsilon(0).margin(c.error));
  }
}

TEST_CASE("a motor hands over behind stops and cables as it does alone") {
  const std::vector<std::string> limited{"forces[0].current_limit=3.6", "forces[0].torque_constant=0.005"};
  const Simulation alone = run_scene(crank, limited), among = run_scene(crank + R"(
[[forces]]
kind = "spring"
nodes = ["E", "T"]
stiffness = 3
free_length = 5.0
tension_only = true
[[constraints]]
kind = "angle_stop"
nodes = ["E", "O", "T"]
axis = [0, 0, 1]
max = 100000
)",
                                                                        limited);
  REQUIRE(alone.events.size() == 1);
  REQUIRE(among.events.size() == 1);  // never stretched, never touched
  CHECK(among.events[0].name == alone.events[0].name);
  CHECK(among.events[0].t == Approx(alone.events[0].t).epsilon(0).margin(1e-12));
  CHECK((end_positions(among) - end_positions(alone)).cwiseAbs().maxCoeff() <= 1e-12);
}

// Full voltage as long as the controller asks for more, k (r - th') > n T_0 (1 - n th' / w_0), then th' = r -
// (r - th'_1) exp(-k t / I).
TEST_CASE("a controller takes over from full voltage at the right time by every method") {
  const double r = 60 * pi / 180, k = 2.5, t = 1.5, top = no_load / ratio,
               tau = inertia * top / (ratio * stall);
  const double rate1 = (k * r - ratio * stall) / (k - ratio * stall / top),
               t1 = -tau * std::log(1 - rate1 / top);
  const double angle1 = top * (t1 - tau * (1 - std::exp(-t1 / tau))), rest = t - t1;
  const double angle =
      start_angle + angle1 + r * rest - (r - rate1) * inertia / k * (1 - std::exp(-k * rest / inertia));
  REQUIRE((rate1 > 0 && t1 < 1.0));
  struct Case {
    const char* method;
    double step, error;
  };
  for (const Case& c :
       {Case{"dvm", 0.0137, 1e-10}, Case{"rk4", 0.0013, 1e-9}, Case{"rk4_baumgarte", 0.0013, 1e-9}}) {
    const Simulation run =
        run_scene(crank, {"forces[0].control=rate", "forces[0].motion=rate", "forces[0].rate=60",
                          "forces[0].proportional=2.5", std::string("solver.method=") + c.method,
                          "solver.step=" + std::to_string(c.step)});
    INFO(c.method);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].name == "motor gives what is asked");
    CHECK(run.events[0].t == Approx(t1).epsilon(0).margin(c.error));
    CHECK(last_of(diagnose(run), "motor.angle_rad") == Approx(angle).epsilon(0).margin(c.error));
  }
}

// Full voltage backwards, the controller, full voltage forwards, the controller again: what the
// parts say one after the other, by the classic Runge-Kutta method in steps that end where they change
// (bisection), of one equation.
TEST_CASE("a controller that overshoots its voltage both ways keeps the order") {
  const double k = 4, c = 0.6, aim = start_angle, top = no_load / ratio;
  int part = -1;
  const auto torque = [&](double th, double u, int of) {
    const double asked = k * (aim - th) - c * u;
    return of == 0 ? asked : ratio * stall * (of - u / top);
  };
  const auto room = [&](double th, double u) {
    const double asked = torque(th, u, 0);
    if (part == 0) return std::min(torque(th, u, 1) - asked, asked - torque(th, u, -1));
    return part * (asked - torque(th, u, part));
  };
  double t = 0, th = start_angle, u = 5;  // 2.5 m/s at 0.5 m
  std::vector<double> switches;
  const auto step = [&](double h, double& to_th, double& to_u) {
    const auto a = [&](double x, double y) { return torque(x, y, part) / inertia; };
    const double k1 = a(th, u), k2 = a(th + h / 2 * u, u + h / 2 * k1),
                 k3 = a(th + h / 2 * (u + h / 2 * k1), u + h / 2 * k2),
                 k4 = a(th + h * (u + h / 2 * k2), u + h * k3);
    to_th = th + h * u + h * h / 6 * (k1 + k2 + k3), to_u = u + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  };
  while (t < 5) {
    double h = std::min(1e-4, 5 - t), next_th = 0, next_u = 0;
    step(h, next_th, next_u);
    if (room(next_th, next_u) < 0) {
      double low = 0, high = h;
      for (int i = 0; i < 60; ++i) {
        h = 0.5 * (low + high);
        step(h, next_th, next_u);
        (room(next_th, next_u) < 0 ? high : low) = h;
      }
      switches.push_back(t + h);
      th = next_th, u = next_u, t += h;
      part = part != 0 ? 0 : torque(th, u, 0) > 0 ? 1 : -1;
      continue;
    }
    th = next_th, u = next_u, t += h;
  }
  REQUIRE(switches.size() >= 3);
  const Simulation run = run_scene(
      crank, {"forces[0].control=position", "forces[0].motion=hold", "forces[0].proportional=4",
              "forces[0].derivative=0.6", "structure.nodes[2].velocity=[-2, 1.5, 0]", "solver.end_time=5"});
  REQUIRE(run.events.size() == switches.size());
  for (std::size_t i = 0; i < switches.size(); ++i)
    CHECK(run.events[i].t == Approx(switches[i]).epsilon(0).margin(1e-9));
  CHECK(last_of(diagnose(run), "motor.angle_rad") == Approx(th).epsilon(0).margin(1e-9));
}

// PD: I th'' = k (f - th) - c th', an oscillator about f. With k_i the third-order equation
// I e''' + c e'' + k e' + k_i e = 0 and the load's constant torque is taken away.
TEST_CASE("a controller holds an angle as its equations say") {
  const std::vector<std::string> strong = {
      "forces[0].stall_torque=3",   "forces[0].no_load_speed=300000",
      "forces[0].control=position", "forces[0].motion=hold",
      "forces[0].proportional=2",   "structure.nodes[2].velocity=[-0.8, 0.6, 0]"};
  const double w = std::sqrt(2 / inertia), rate = 2.0;  // 1 m/s at 0.5 m
  const Simulation swing = run_scene(crank, strong);
  CHECK(last_of(diagnose(swing), "motor.angle_rad") ==
        Approx(start_angle + rate / w * std::sin(w * 1.5)).epsilon(0).margin(1e-8));
  // With gains for three equal roots at -6 /s: k = 3 * 36 I, c = 18 I, k_i = 216 I. From rest with a constant
  // torque M = -0.4 N m: e = (M / I) t^2 / 2 * exp(-6 t) has this equation's initial values e = e' = 0, e'' =
  // -M/I.
  std::vector<std::string> pid(strong);
  pid[4] = "forces[0].proportional=" + std::to_string(108 * inertia);
  pid[5] = "forces[0].derivative=" + std::to_string(18 * inertia);
  pid.push_back("forces[0].integral=" + std::to_string(216 * inertia));
  const Simulation run = run_scene(crank + R"(
[[forces]]
kind = "torsion_spring"
nodes = ["E", "O", "T"]
axis = [0, 0, 1]
stiffness = 1e-9
free_angle = -2.2918311805232929e10
)",
                                   pid);
  REQUIRE(run.status == RunStatus::completed);
  const double moment = -1e-9 * (start_angle + 2.2918311805232929e10 * pi / 180);  // -0.4, constant to 1e-9
  const double e = -moment / inertia * 1.5 * 1.5 / 2 * std::exp(-9.0);
  CHECK(last_of(diagnose(run), "motor.angle_rad") == Approx(start_angle - e).epsilon(0).margin(1e-7));
}

// What sums up the error of a controller moves along with the mechanism in the solver; kinetic energy is that
// of the masses alone, m v^2 / 2 of the crank's, however slowly they move beside an error of half a radian.
TEST_CASE("the integral of a controller has no energy") {
  std::vector<std::string> changes;
  for (const char* change : {"control=\"position\"", "motion=\"smooth\"", "to=80", "duration=30",
                             "proportional=0.01", "derivative=0.1", "integral=0.001"})
    changes.push_back(std::string("forces[0].") + change);
  changes.insert(changes.end(), {"solver.step=0.1", "solver.end_time=30"});
  const Simulation run = run_scene(crank, changes);
  REQUIRE(run.status == RunStatus::completed);
  const Diagnostics d = diagnose(run);
  const double most = testing::largest(d, "kinetic_energy_J");
  CHECK(most > 1e-6);
  double apart = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double v = run.trajectory.node_velocities(i).segment<3>(6).norm();
    apart = std::max(apart, std::abs(d.at("kinetic_energy_J").values[i] - 0.5 * 0.7 * v * v));
  }
  CHECK(apart <= 1e-12 * most);                                   // round-off
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-9 * most);  // of order 8, 300 steps of a smooth motion
}

TEST_CASE("a controller of the rate follows its command") {
  const Simulation run = run_scene(
      crank, {"forces[0].stall_torque=3", "forces[0].no_load_speed=300000", "forces[0].control=rate",
              "forces[0].motion=rate", "forces[0].rate=40", "forces[0].proportional=5"});
  // I th'' = k (r - th'): th' = r (1 - exp(-k t / I))
  const double r = 40 * pi / 180, k = 5 / inertia, t = 1.5;
  CHECK(last_of(diagnose(run), "motor.angle_rad") ==
        Approx(start_angle + r * (t - (1 - std::exp(-k * t)) / k)).epsilon(0).margin(1e-6));
}

// A winch lifts 2 kg: (m + n^2 J / r^2) x'' = n T / r - m g with T on the line.
// The integral of the rate's error is (f - f(0)) - (th - th(0)): the law of a controller of the position,
// along a table that begins where the crank is, with both gains in each other's place.
TEST_CASE("a controller of the rate knows nothing of the values that its table begins with") {
  const auto run = [](const char* control, const char* of_value, const char* of_rate, double first) {
    const auto at = [&](double x) { return std::to_string(first + x); };
    const std::string force = "forces[0].";
    return run_scene(crank, {force + "control=" + control, force + of_value + "=3", force + of_rate + "=0.4",
                             force + "motion=table", force + "times=[0, 0.5, 0.9]",
                             force + "values=[" + at(0) + ", " + at(60) + ", " + at(20) + "]"});
  };
  const double start = start_angle * 180 / pi;
  const Simulation position = run("position", "proportional", "derivative", start);
  for (const double first : {0.0, start, -500.0, 1080.0}) {
    const Simulation rate = run("rate", "integral", "proportional", first);
    INFO("from " << first);
    REQUIRE(rate.status == RunStatus::completed);
    CHECK(diagnose(rate).at("motor.torque_N_m").values.front() == Approx(0).epsilon(0).margin(1e-12));
    CHECK((end_positions(rate) - end_positions(position)).norm() <=
          1e-7);  // six digits of the table's degrees
  }
}

TEST_CASE("a winch draws in what hangs on its cable") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [
  {name = "P", position = [0, 0, 3], fixed = true}, {name = "Q", position = [0.9, 0, 3], fixed = true},
  {name = "A", position = [0, 0, 1], mass = 2}]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "winch"
name = "winch"
nodes = ["A", "P", "Q"]
stall_torque = 0.2
no_load_speed = 6000
gear_ratio = 12
drum_radius = 0.05
inertia = 1e-4
[solver]
stages = 4
step = 0.01
end_time = 0.8
)";
  const double m = 2 + 144 * 1e-4 / 0.0025, pull = 12 * 0.2 / 0.05, top = 6000 * pi / 180 * 0.05 / 12;
  const double end = top * (1 - 2 * 9.81 / pull), tau = m * top / pull, t = 0.8;
  const double x = end * (t - tau * (1 - std::exp(-t / tau)));
  const Simulation run = run_scene(text);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(end_positions(run)[8] == Approx(1 + x).epsilon(0).margin(1e-9));
  const Diagnostics d = diagnose(run);
  CHECK(last_of(d, "winch.value_m") == Approx(x).epsilon(0).margin(1e-9));
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-8);
}

// A winch that draws in half of its elastic cable, whose unstressed length is L = l - x then:
//
//     V = E A (s - L)^2 / (2 L),   m z'' = N - m g,   M x'' = (n / r) T - N - N^2 / (2 E A),   N = E A (s / L
//     - 1)
//
// by the classic Runge-Kutta method, whose steps leave less than 1e-10 m (halved ones change 1e-11 m). As
// stiff as it was at t = 0 the cable would be longer by 0.01 m in the end.
TEST_CASE("a cable on a drum is the stiffer the less of it is left") {
  const double EA = 900, l = 2.1, m = 1.7, g = 9.81, n = 30, J = 2e-4, r = 0.05, stalled = 0.09,
               top = 9000 * pi / 180;
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "W", position = [0, 0, 0], fixed = true}, {name = "A", position = [0, 0, -2.1], mass = 1.7}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [0, 0, 1]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "winch"
name = "winch"
nodes = ["W", "A"]
stall_torque = 0.09
no_load_speed = 9000
gear_ratio = 30
drum_radius = 0.05
inertia = 2e-4
axial_stiffness = 900
[solver]
stages = 5
step = 0.005
end_time = 6.5
)");
  REQUIRE(run.status == RunStatus::completed);
  struct Point {
    double z, v, x, u;
  };
  const auto slope = [&](const Point& p) {
    const double left = l - p.x, N = std::max(EA * (-p.z / left - 1), 0.0);
    const double torque = n * stalled * (1 - n * p.u / (r * top));
    return Point{p.v, N / m - g, p.u, (torque / r - N - N * N / (2 * EA)) / (n * n * J / (r * r))};
  };
  const auto moved = [](const Point& p, const Point& k, double h) {
    return Point{p.z + h * k.z, p.v + h * k.v, p.x + h * k.x, p.u + h * k.u};
  };
  Point p{-l, 0, 0, 0};
  constexpr int steps = 65000;
  for (int i = 0; i < steps; ++i) {
    const double h = 6.5 / steps;
    const Point a = slope(p), b = slope(moved(p, a, h / 2)), c = slope(moved(p, b, h / 2)),
                e = slope(moved(p, c, h));
    p = moved(moved(moved(moved(p, a, h / 6), b, h / 3), c, h / 3), e, h / 6);
  }
  REQUIRE(p.x > 0.5 * l);
  CHECK(end_positions(run)[5] == Approx(p.z).epsilon(0).margin(2e-8));
  const Diagnostics d = diagnose(run);
  CHECK(last_of(d, "winch.value_m") == Approx(p.x).epsilon(0).margin(2e-8));
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-7);
}

// A rotor is a number of its own, not a mass that hangs anywhere.
TEST_CASE("the books of a motor close under gravity in any direction") {
  for (const char* gravity : {"[-3.3, -5, 1.7]", "[4.1, 0, 0]"}) {
    const Simulation run = run_scene(crank, {std::string("gravity.acceleration=") + gravity,
                                             "forces[0].inertia=4e-5", "solver.step=0.01"});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-8);
  }
}

// Rotors and drums are nodes of their own behind those of the scene, which entries that follow name.
TEST_CASE("entries behind motors with rotors and winches find their nodes") {
  std::string text = crank;
  for (const char* kind : {"motor", "winch", "motor"})
    text += std::string("[[forces]]\nkind = \"") + kind + "\"\nnodes = [\"E\", \"O\", \"T\"]\n" +
            "stall_torque = 0.1\nno_load_speed = 3000\ninertia = 1e-4\n" +
            (std::string(kind) == "winch" ? "drum_radius = 0.1\n" : "axis = [0, 0, 1]\n");
  text += "[[forces]]\nkind = \"spring\"\nnodes = [\"E\", \"T\"]\nstiffness = 1\n";
  text += "[[constraints]]\nkind = \"length_stop\"\nnodes = [\"E\", \"T\"]\nmin = 0.1\n";
  CHECK(error_of(text) == "");
  CHECK(model_of(text)->structure.nodes.size() == 6);
}

TEST_CASE("columns of motors are measures by name") {
  const auto model = testing::model_of(crank);
  const auto columns = columns_of(model);
  const Simulation run = run_scene(crank);
  const Diagnostics d = diagnose(run);
  CHECK(find_measure("max:motor.torque_N_m", columns).value(run, d) == Approx(ratio * stall).epsilon(1e-12));
}

TEST_CASE("motors that cannot be say what is wrong") {
  CHECK(error_of(crank, {"forces[0].gear_ratio=0"}).find("gear_ratio: must not be 0") != std::string::npos);
  CHECK(error_of(crank, {"forces[0].current_limit=2"}).find("torque_constant: is missing") !=
        std::string::npos);
  CHECK(error_of(crank, {"forces[0].control=position"}).find("it would do nothing") != std::string::npos);
  CHECK(error_of(crank, {"forces[0].control=position", "forces[0].derivative=1"}) == "");
  // A rate has no derivative to follow.
  CHECK(error_of(crank, {"forces[0].control=rate", "forces[0].derivative=1"})
            .find("so is integral: it would do nothing") != std::string::npos);
}

}  // namespace motor_test
