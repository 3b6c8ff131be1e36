// SPDX-License-Identifier: BSD-3-Clause
// Drives that lead to a flat pose, in which the constraints lose rank, or through it.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace driven_flat_pose_test {

namespace {

using testing::number;
using testing::run_scene;

constexpr double start = 60 * radians_per_degree;

// Two legs and a coupler of 1 m and 1 kg on pivots in one line, the first leg led from 60 degrees in 1 s, and
// `nodes`, `rods` beside them.
std::string linkage(const std::string& to, double gravity, const std::string& nodes = "",
                    const std::string& rods = "") {
  return R"toml(
[structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = [0.5, 0, 0.8660254037844386]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = [1.2, 0, 0.8660254037844386]})toml" +
         nodes + R"(]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1})" +
         rods + R"(]
[[structure.constraints]]
kind = "plane"
nodes = ["B*"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, )" +
         std::to_string(-gravity) + R"(]
[deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
[[constraints]]
kind = "angle"
name = "m"
nodes = ["X", "A0", "B0"]
axis = [0, -1, 0]
)" + to + R"(
[solver]
step = 0.01
stages = 4
end_time = 2
)";
}
std::string smooth(double to) {
  return "motion = \"smooth\"\nduration = 1\nto = " + std::to_string(to);
}
const std::string mass = R"(, {name = "Q", position = [5.8, 0, 3], mass = 2, velocity = [3, 0, 0]})";

double deployed_at(const Simulation& run) {
  for (const Event& event : run.events)
    if (event.kind == "deployed") return event.t;
  return -1;
}
Vec3 last(const Simulation& run, const std::string& name, bool velocity = false) {
  const Trajectory& t = run.trajectory;
  const VectorXd of = velocity ? t.node_velocities(t.size() - 1) : t.node_positions(t.size() - 1);
  const auto& nodes = t.structure().nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].name == name) return of.segment<3>(3 * static_cast<Index>(i));
  return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

// Share, rate and acceleration of smooth motion in 1 s.
std::array<double, 3> share(double u) {
  return {u * u * u * (10 - 15 * u + 6 * u * u), 30 * u * u * (1 - u) * (1 - u),
          60 * u * (1 - u) * (1 - 2 * u)};
}

}  // namespace

// A mass that nothing touches is where its throw takes it in 1 s; 12 digits are those of the polynomial
// through states up to 0.12 s before, whose weights add up to some 4000.
TEST_CASE("what moves beside a drive that comes to rest in a flat pose goes on until it does") {
  const std::string table = "motion = \"table\"\ntimes = [0, 0.4, 1]\nvalues = [60, 30, 0]";
  for (const double g : {0.0, 9.81})
    for (const int copies : {0, 4, 8, -1}) {
      std::string rods;
      for (int i = 0; i < copies; ++i)
        rods += R"(, {name = "copy )" + std::to_string(i) + R"(", nodes = ["A1", "B1"], mass = 0.1})";
      const Simulation run = run_scene(linkage(copies < 0 ? table : smooth(0), g, mass, rods));
      CAPTURE(g, copies, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
      CHECK(run.trajectory.end_time() == deployed_at(run));
      CHECK((last(run, "Q") - Vec3(8.8, 0, 3 - 0.5 * g)).norm() < 1e-10);
      CHECK((last(run, "Q", true) - Vec3(3, 0, -g)).norm() < 1e-10);
      // Rounding d of a rod's length turns its end by d / sine of the angle left, 1e-5 a step before.
      CHECK((last(run, "B1") - Vec3(1.7, 0, 0)).norm() < 1e-8);
      CHECK(last(run, "B1", true).norm() < 1e-7);
    }
}

namespace {

// What pulls a payload aside, on one line from each millisecond to the next.
double pull(double t) {
  const double i = std::floor(t / 1e-3 + 1e-6), part = t / 1e-3 - i;
  return 2 * ((1 - part) * std::sin(13e-3 * i) + part * std::sin(13e-3 * (i + 1)));
}
std::string pulls(const std::string& node) {
  std::string times, values;
  for (int i = 0; i <= 1200; ++i) {
    times += (i ? ", " : "") + number(1e-3 * i);
    values += (i ? ", " : "") + number(pull(1e-3 * i));
  }
  return "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"" + node + "\"]\nforce = [1, 0, 0]\ntimes = [" +
         times + "]\nvalues = [" + values + "]\n";
}

constexpr double payload = 0.5, length = 0.5, rod = 0.2, weight = 9.81;

// A payload that hangs from the second leg's end, after 1 s: a pendulum on a support that moves on the leg's
// circle, its angle and rate.
Eigen::Vector2d swung(bool pulled) {
  using Pair = Eigen::Vector2d;
  constexpr double inertia = (payload + rod / 3) * length * length, moment = (payload + rod / 2) * length;
  const auto slope = [&](double t, const Pair& y) {
    const auto [f, df, ddf] = share(t);
    const double a = start * (1 - f), da = -start * df, dda = -start * ddf,
                 ax = -std::sin(a) * dda - std::cos(a) * da * da,
                 az = std::cos(a) * dda - std::sin(a) * da * da, aside = pulled ? length * pull(t) : 0;
    const double turning = moment * (ax * std::cos(y[0]) + (az + weight) * std::sin(y[0]));
    return Pair(y[1], (aside * std::cos(y[0]) - turning) / inertia);
  };
  Pair y(0, 0);
  constexpr int steps = 2000;  // Runge-Kutta's, off by (4.4 / 2000)^4 or so
  constexpr double h = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const Pair a = slope(t, y), b = slope(t + h / 2, y + h / 2 * a), c = slope(t + h / 2, y + h / 2 * b),
               d = slope(t + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

}  // namespace

TEST_CASE("a payload on what a drive lays flat is where it swings to") {
  const std::string nodes = R"toml(, {name = "Q", position = [1.2, 0, 0.3660254037844386], mass = 0.5})toml";
  for (const bool pulled : {false, true}) {
    const Eigen::Vector2d y = swung(pulled);
    const Vec3 at(1.7 + length * std::sin(y[0]), 0, -length * std::cos(y[0])),
        rate(length * std::cos(y[0]) * y[1], 0, length * std::sin(y[0]) * y[1]);
    const std::string scene = linkage(smooth(0), weight, nodes, R"(, {nodes = ["B1", "Q"], mass = 0.2})") +
                              (pulled ? pulls("Q") : "");
    for (const std::vector<std::string>& how :
         std::vector<std::vector<std::string>>{{"solver.step=0.01"},
                                               {"solver.step=0.0101"},
                                               {"solver.step=0.005"},
                                               {"solver.step=0.004", "solver.method=\"rk4_projected\""}}) {
      std::vector<std::string> changes = how;
      changes.push_back("structure.constraints[0].nodes=[\"B*\", \"Q\"]");
      const Simulation run = run_scene(scene, changes);
      CAPTURE(pulled, how, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
      CHECK((last(run, "Q") - at).norm() < 1e-8);
      // As much of rounding in the leg's rate next to the pose.
      CHECK((last(run, "Q", true) - rate).norm() < 1e-6);
      // The legs' and the coupler's forces have no bound there, the payload's has.
      const VectorXd& lambda = run.trajectory.state(run.trajectory.size() - 1).lambda;
      const std::vector<int>& rows = run.trajectory.last_model().system.rod_rows();
      for (std::size_t i = 0; i < 4; ++i) CHECK(std::isnan(lambda[rows[i]]) == (i < 3));
    }
  }
}

// A mass on a spring beside it swings as m x'' = -k x, 11 to 63 steps in ten of its periods, and with what
// the method leaves of that, some (h w)^12 / 1e8 a step; and legs that a drive has brought to rest are at
// rest.
TEST_CASE("what swings beside what a drive lays flat takes nothing from it and has all of its swing") {
  const std::string nodes =
      ", {name = \"W\", position = [0, 0, -5], fixed = true}, {name = \"S\", position = [1.1, 0, -5], mass = "
      "1}, {name = \"V\", position = [20, 0, 0], mass = 1, velocity = [0.7, 0, 0]}";
  for (const double to : {0.0, -5.0})
    for (const double stiffness : {3e3, 1e4, 4e4}) {
      if (to == 0 && stiffness == 4e4) continue;
      const Simulation run = run_scene(
          linkage(smooth(to), 9.81, nodes) + "[[forces]]\nkind = \"spring\"\nnodes = [\"W\", \"S\"]\n" +
              "free_length = 1\nstiffness = " + std::to_string(stiffness) +
              "\n[[constraints]]\nkind = \"line\"\nnodes = [\"S\"]\ndirection = [1, 0, 0]\n" +
              "[[constraints]]\nkind = \"coordinate\"\nnodes = [\"V\"]\ndirection = [1, 0, 0]\n" +
              "motion = \"rate\"\nrate = 0.7\n",
          {"solver.stages=8"});
      CAPTURE(to, stiffness, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      if (to == 0) CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
      const double w = std::sqrt(stiffness), t = deployed_at(run);
      CHECK(last(run, "S").x() == Approx(1 + 0.1 * std::cos(w * t)).epsilon(0).margin(1e-8));
      CHECK(last(run, "S", true).x() == Approx(-0.1 * w * std::sin(w * t)).epsilon(0).margin(1e-6));
      CHECK(last(run, "V").x() == Approx(20 + 0.7 * t).epsilon(1e-12));
      CHECK((last(run, "B1") - Vec3(1.7, 0, 0)).norm() < 1e-8);
      if (to == 0) CHECK(last(run, "B1", true).norm() < 1e-7);
    }
}

namespace {

// The same linkage afloat, with a payload on its second leg if it has one: what a drive leads there is no
// node's motion.
std::string afloat(const std::string& nodes = "", const std::string& rods = "",
                   const std::string& rest = "") {
  return R"toml([structure]
kind = "custom"
nodes = [{name = "A0", position = [0, 0, 0], mass = 3}, {name = "B0", position = [0.5, 0, 0.8660254037844386]},
  {name = "A1", position = [0.7, 0, 0], mass = 2}, {name = "B1", position = [1.2, 0, 0.8660254037844386]},
  {name = "W", position = [0, 0, -5], fixed = true}, {name = "S", position = [1.1, 0, -5], mass = 1})toml" +
         nodes + R"(]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1},
  {nodes = ["A0", "A1"], mass = 1})" +
         rods + R"(]
constraints = [{kind = "plane", nodes = ["A*", "B*"], normal = [0, 1, 0]}, {kind = "line", nodes = ["S"], direction = [1, 0, 0]}]
[deployment]
measure = "angle A1 A0 B0 about 0 -1 0"
deployed = 0
[[forces]]
kind = "spring"
nodes = ["W", "S"]
stiffness = 1e4
free_length = 1
[[constraints]]
kind = "angle"
nodes = ["A1", "A0", "B0"]
axis = [0, -1, 0]
)" + smooth(0) +
         rest + "\n[solver]\nstages = 6\nend_time = 2\n";
}

}  // namespace

// All in one line; at rest, as it has been at first, but for the mass.
TEST_CASE("what swings beside a floating linkage that a drive lays flat takes nothing from it") {
  const Simulation run = run_scene(afloat(), {"solver.step=0.01"});
  REQUIRE(run.status == RunStatus::deployed);
  CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
  CHECK(last(run, "S").x() == Approx(1 + 0.1 * std::cos(100.0)).epsilon(0).margin(1e-8));
  const Vec3 along = (last(run, "A1") - last(run, "A0")) / 0.7;
  for (const char* leg : {"0", "1"}) {
    const std::string a = "A" + std::string(leg), b = "B" + std::string(leg);
    CHECK((last(run, b) - last(run, a) - along).norm() < 1e-8);
    CHECK(last(run, b, true).norm() < 1e-7);
  }
}

// The linkage that a payload on a stiff hinge shakes is nothing that drives alone move.
TEST_CASE("what is not known of a flat pose to which a drive leads is told") {
  const std::string scene =
      afloat(R"toml(, {name = "P", position = [1.2, 0, 0.3660254037844386], mass = 0.1})toml",
             R"(, {nodes = ["B1", "P"], mass = 0})",
             "\n[[forces]]\nkind = \"torsion_spring\"\nnodes = [\"A1\", \"B1\", \"P\"]\nstiffness = 30\n"
             "free_angle = 90\n[[constraints]]\nkind = \"plane\"\nnodes = [\"P\"]\nnormal = [0, 1, 0]\n");
  for (const auto& [floats, known] : {std::pair(afloat(), true), {scene, false}}) {
    const Simulation run = run_scene(floats, {"solver.step=0.002"});
    CAPTURE(known, run.message);
    REQUIRE(run.status == RunStatus::deployed);
    CHECK(known == std::ranges::none_of(run.warnings, [](const std::string& warning) {
            return warning.find("was not found well, and the state may be off by") != std::string::npos;
          }));
  }
}

// A ball falls beside it and leaves the ground with 0.8 of its rate, up to two steps before the pose.
TEST_CASE("what strikes beside what a drive lays flat takes nothing from it") {
  for (const double landing : {0.95, 0.98, 0.993}) {
    const std::string ball = ", {name = \"S\", position = [5, 0, " +
                             std::to_string(0.5 * 9.81 * landing * landing) + "], mass = 1}";
    const Simulation run = run_scene(linkage(smooth(0), 9.81, ball) +
                                         "[[constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"S\"]\n"
                                         "direction = [0, 0, 1]\nmin = 0\nrestitution = 0.8\n",
                                     {"solver.step=0.004"});
    CAPTURE(landing, run.message);
    REQUIRE(run.status == RunStatus::deployed);
    CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
    const double left = 1 - landing;  // its height is given to 1e-6 m
    CHECK(last(run, "S").z() == Approx(9.81 * left * (0.8 * landing - 0.5 * left)).epsilon(0).margin(2e-6));
    CHECK((last(run, "B1") - Vec3(1.7, 0, 0)).norm() < 1e-8);
    CHECK(last(run, "B1", true).norm() < 1e-6);
  }
}

// Within the last milliseconds no step tells what is led, which is known all the same: the ball lands when it
// falls that far. Of a step of 5 ms rk4's rates of the legs are off by as much as its order leaves.
TEST_CASE(
    "what strikes beside a drive that is about to come to rest in a flat pose does so at its own time") {
  constexpr double apart = 1e-13;  // of a time near 1 s, by 20 additions
  for (const double landing : {0.9965, 0.9983, 0.99967})
    for (const char* how :
         {"solver.step=0.01", "solver.step=0.004", "solver.method=\"rk4\"", "solver.method=\"rk4_projected\"",
          "solver.method=\"rk4_baumgarte\"", "solver.method=\"generalized_alpha\""}) {
      const std::string ball =
          ", {name = \"S\", position = [5, 0, " + number(0.5 * 9.81 * landing * landing) + "], mass = 1}";
      std::vector<std::string> changes{how};
      const bool other = changes[0].find("method") != std::string::npos;
      if (other && landing != 0.9983) continue;
      if (other) changes.push_back("solver.step=0.005");
      const Simulation run = run_scene(linkage(smooth(0), 9.81, ball) +
                                           "[[constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"S\"]\n"
                                           "direction = [0, 0, 1]\nmin = 0\nrestitution = 0.8\n",
                                       changes);
      CAPTURE(landing, how, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      REQUIRE(run.events.size() == 2);
      CHECK(run.events[0].kind == "contact");
      CHECK(run.events[0].t == Approx(landing).epsilon(0).margin(apart));
      CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
      const double left = 1 - landing;
      CHECK(last(run, "S").z() ==
            Approx(9.81 * left * (0.8 * landing - 0.5 * left)).epsilon(0).margin(1e-12));
      CHECK((last(run, "B1") - Vec3(1.7, 0, 0)).norm() < 1e-8);
      CHECK(last(run, "B1", true).norm() < 1e-6);
    }
}

// The other leg's angle falls as the drive's does, as the cube of the time left: less than rounding of the
// rods' lengths, 1e-16 over the sine of the poses that tell, in the last half of a millisecond.
TEST_CASE("a stop in the flat pose to which a drive leads is met once and at rest") {
  for (const char* then : {"stop", "pass", "latch"})
    for (const char* step : {"0.01", "0.0047", "0.002"}) {
      const Simulation run = run_scene(linkage(smooth(0), 9.81) +
                                           "[[constraints]]\nkind = \"angle_stop\"\nname = \"as\"\n"
                                           "nodes = [\"X\", \"A1\", \"B1\"]\naxis = [0, -1, 0]\nmin = 0\n",
                                       {"solver.at_deployed=\"" + std::string(then) + "\"", "solver.stages=5",
                                        "solver.end_time=1.1", std::string("solver.step=") + step});
      CAPTURE(then, step, run.message);
      CHECK(run.status != RunStatus::failed);
      CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
      CHECK(std::ranges::count(run.events, "contact", &Event::kind) <= 1);
      for (const Event& event : run.events) CHECK(event.t > 1 - 5e-4);
      CHECK((last(run, "B1") - Vec3(1.7, 0, 0)).norm() < 1e-8);
    }
}

// The time is the drive's own, start + (to - start) share(t) = 0; B1 falls at the leg's rate. The drive's
// work of some 20 J is that of a quadrature of order 6.
TEST_CASE("a drive that leads through a flat pose deploys it at its own time at every step") {
  for (const double to : {-0.001, -0.3, -1.0, -3.0, -5.0, -10.0}) {
    const double part = 60 / (60 - to);
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (share(middle)[0] < part ? low : high) = middle;
    }
    const double rate = (to - 60) * radians_per_degree * share(low)[1];
    for (const char* step : {"0.02", "0.01", "0.008", "0.005", "0.002"})
      for (const char* stages : {"4", "6"}) {
        const Simulation run =
            run_scene(linkage(smooth(to), to == -0.001 ? 0.0 : 9.81, mass),
                      {std::string("solver.step=") + step, std::string("solver.stages=") + stages});
        CAPTURE(to, step, stages, run.message);
        CHECK(run.status == RunStatus::deployed);
        CHECK(deployed_at(run) == Approx(low).epsilon(1e-10));
        CHECK(last(run, "Q").x() == Approx(5.8 + 3 * low).epsilon(1e-10));
        CHECK(last(run, "B1", true).z() == Approx(rate).epsilon(1e-5));
        CHECK(testing::largest(diagnose(run), "energy_balance_J") < 1e-5);
      }
  }
}

TEST_CASE("a run goes on from a flat pose in which its drive has come to rest") {
  for (const char* then : {"pass", "latch"})
    for (const char* how :
         {"solver.stages=4", "solver.stages=7", "solver.step=0.0101", "solver.adaptive=true"}) {
      const Simulation run =
          run_scene(linkage(smooth(0), 9.81, mass), {std::string("solver.at_deployed=") + then, how});
      CAPTURE(then, how, run.message);
      CHECK(run.status == RunStatus::completed);
      CHECK(deployed_at(run) == Approx(1).epsilon(1e-14));
      CHECK((last(run, "Q") - Vec3(11.8, 0, 3 - 2 * 9.81)).norm() < 1e-9);
    }
}

// By virtual work in the flat pose at rest: M per height h of the posts that each of 12 hinges of 200 N and
// 3 m asks for, and the posts' own share of it. Accelerations go with the cube root of what is left there.
TEST_CASE("forces where a drive has come to rest in a flat pose are those of statics") {
  for (const char* method : {"dvm", "rk4"}) {
    const Scene scene = read_scene_file(
        find_scene("hoop6_motor"),
        {"structure.model=joints", "structure.fold_angle=50", "structure.hinge_force=200",
         "constraints[0].to=0", "constraints[0].duration=0.8", std::string("solver.method=") + method});
    const Simulation run = simulate(build_model(scene), scene.solver);
    CAPTURE(method, run.message);
    REQUIRE(run.status == RunStatus::deployed);
    const Diagnostics of = diagnose(run);
    CHECK(of.axial_force.row(of.axial_force.rows() - 1).maxCoeff() == Approx(200).epsilon(1e-4));
  }
}

// By virtual work: weights of 0.5, 0.5 and 1 kg and the load rise by the legs' 1 m per radian. Accelerations
// go with the cube root of rounding in what is left: 1e-5 of them.
TEST_CASE(
    "a torque in a flat pose is that of statics with a load that bends just before or a large one beside") {
  const std::string load = R"(
[[forces]]
kind = "load_over_time"
nodes = ["B1"]
force = [0, 0, -10]
values = [0, 1, 1]
times = [0, )",
                    post = R"(
[[constraints]]
kind = "plane"
nodes = ["T"]
normal = [1, 0, 0]
[[loads]]
nodes = ["T"]
force = [0, 0, -1e6])",
                    nodes = R"(, {name = "S", position = [25, 0, 0], fixed = true},
  {name = "T", position = [25, 0, 1], mass = 1})",
                    rods = R"(, {nodes = ["S", "T"], mass = 0})";
  for (const bool beside : {false, true})
    for (const char* bend : {"0.5", "0.99", "0.995"}) {
      const Simulation run = run_scene(linkage(smooth(0) + load + bend + ", 2]" + (beside ? post : ""), 9.81,
                                               beside ? nodes : "", beside ? rods : ""));
      CAPTURE(beside, bend, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      const Diagnostics of = diagnose(run);
      CHECK(of.at("m.torque_unique").values.back() == 1);
      CHECK(std::abs(of.at("m.torque_N_m").values.back()) == Approx(29.62).epsilon(0).margin(1e-3));
    }
}

TEST_CASE("a ring whose mean angle a motor leads is deployed when that has come to its end") {
  const Scene scene = read_scene_file(find_scene("hoop6_motor"),
                                      {"structure.model=joints", "constraints[0].to=0",
                                       "structure.perturbed_unit=1", "structure.perturbed_force=2"});
  const Simulation run = simulate(build_model(scene), scene.solver);
  CHECK(run.status == RunStatus::deployed);
  CHECK(deployed_at(run) == Approx(5).epsilon(1e-14));
}

TEST_CASE(
    "a linkage is deployed when its drive has come to its end, by whichever of its nodes that is told") {
  // The second crank of a parallelogram is as high as the first one, which is led to z = 0: a height of 1e-8
  // is rounding in the flat pose, and 4 ms of the motion before it.
  const char* const cranks = R"(
[structure]
kind = "custom"
nodes = [{name = "A0", position = [0, 0, 0], fixed = true}, {name = "A1", position = [0.7, 0, 0], fixed = true},
         {name = "B0", position = [0.5, 0, 0.8660254037844386]},
         {name = "B1", position = [1.2, 0, 0.8660254037844386]},
         {name = "P", position = [1.2, 0, 0.3660254037844386], mass = 0.5}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1},
        {nodes = ["B1", "P"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["B*", "P"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[[constraints]]
kind = "coordinate"
name = "m"
nodes = ["B0"]
direction = [0, 0, 1]
motion = "smooth"
to = 0
duration = 0.5
[deployment]
deployed = 0
[solver]
end_time = 0.8
)";
  for (const char* node : {"B0", "B1"})
    for (const char* step : {"0.01", "0.02"})
      for (const char* stages : {"3", "4"}) {
        const Simulation run = testing::run_scene(
            cranks, {std::string("deployment.measure=\"coordinate ") + node + " along 0 0 1\"",
                     std::string("solver.step=") + step, std::string("solver.stages=") + stages});
        CAPTURE(node, step, stages, run.message);
        REQUIRE(run.status == RunStatus::deployed);
        CHECK(run.trajectory.end_time() == Approx(0.5).epsilon(1e-12));
        // What rounding leaves of a height there.
        const VectorXd q = testing::end_positions(run);
        CHECK(std::abs(q[3 * 3 + 2]) < 1e-7);
      }
}

}  // namespace driven_flat_pose_test
