// SPDX-License-Identifier: BSD-3-Clause
// What begins, ends or is asked for at the very time at which a drive leads a linkage through its flat pose,
// where the constraints lose rank: no step that ends there can be solved, and none sets out from there.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/stepper.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace edge_in_flat_pose_test {

namespace {

using testing::run_scene;

constexpr double start = 60 * radians_per_degree, weight = 9.81;

const std::string deployment = R"([deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
)";

// Two legs and a coupler of 1 m and 1 kg on pivots in one line, the first leg led from 60 degrees.
std::string linkage(const std::string& motion, const std::string& nodes = "", const std::string& rods = "",
                    const std::string& more = deployment) {
  return R"toml(
[structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = [0.5, 0, "=sin(60*deg)"]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = [1.2, 0, "=sin(60*deg)"]})toml" +
         nodes + R"(]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1})" +
         rods + R"(]
[[structure.constraints]]
kind = "plane"
nodes = ["B*")" +
         (nodes.empty() ? "" : ", \"K\"") + R"(]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
)" + more +
         R"(
[[constraints]]
kind = "angle"
name = "m"
nodes = ["X", "A0", "B0"]
axis = [0, -1, 0]
motion = "table"
)" + motion +
         R"(
[solver]
step = 0.01
stages = 4
end_time = 1.2
)" + (more == deployment ? "at_deployed = \"pass\"\n" : "");
}
const std::string through = "times = [0, 0.5, 1]\nvalues = [60, 0, -60]",
                  at_once = "times = [0, 1]\nvalues = [60, -60]",
                  and_back = "times = [0, 0.5, 1]\nvalues = [60, 0, 60]";

struct Led {
  double a, da, dda;
};
// From one angle to another, at rest in both: a cubic, which clamped splines through two points are.
Led cubic(double from, double to, double t, double duration) {
  const double u = t / duration, way = to - from;
  if (u >= 1) return {to, 0, 0};
  return {from + way * u * u * (3 - 2 * u), way * 6 * u * (1 - u) / duration,
          way * (6 - 12 * u) / duration / duration};
}
// So is the one through a point in the middle of such a cubic, and those that turn round at rest.
Led led(const std::string& motion, double t) {
  if (motion != and_back) return cubic(start, -start, t, 1);
  return t < 0.5 ? cubic(start, 0, t, 0.5) : cubic(0, start, t - 0.5, 0.5);
}

std::size_t node(const Trajectory& t, const std::string& name) {
  std::size_t i = 0;
  while (t.structure().nodes[i].name != name) ++i;
  return i;
}

// How far the second leg, which the coupler alone leads, is off in all states, and off its rate.
struct Off {
  double place = 0, rate = 0;
};
Off off(const Trajectory& run, const std::string& motion) {
  Off most;
  const auto i = 3 * static_cast<Index>(node(run, "B1"));
  for (std::size_t k = 0; k < run.size(); ++k) {
    const Led is = led(motion, run.time(k));
    const Vec3 at(0.7 + std::cos(is.a), 0, std::sin(is.a)),
        rate(-std::sin(is.a) * is.da, 0, std::cos(is.a) * is.da);
    most.place = std::max(most.place, (Vec3(run.node_positions(k).segment<3>(i)) - at).norm());
    most.rate = std::max(most.rate, (Vec3(run.node_velocities(k).segment<3>(i)) - rate).norm());
  }
  return most;
}

// Rounding turns the coupler by 1e-16 / sine next to the pose and makes 1e-16 / sine^2 of its rate; states
// that are looked at lie at sines from 1e-4 on, but for those of short steps beside a turn.
void check(const Simulation& run, const std::string& motion) {
  REQUIRE(run.status == RunStatus::completed);
  const Off is = off(run.trajectory, motion);
  CHECK(is.place < 1e-9);
  CHECK(is.rate < (motion == and_back ? 2e-6 : 1e-7));
}

// By virtual work of two legs' and the coupler's inertia, 1/3 + 1/3 + 1, and weight.
void check_torque(const Simulation& run, const std::string& motion) {
  const Diagnostics d = diagnose(run);
  const auto& torque = d.at("m.torque_N_m").values;
  for (std::size_t k = 0; k < run.trajectory.size(); ++k) {
    const double t = run.trajectory.time(k);
    if (std::abs(t - 1) < 1e-9) continue;  // the acceleration jumps
    const Led is = led(motion, t);
    const double truth = 5.0 / 3 * is.dda + 2 * weight * std::cos(is.a);
    CAPTURE(t);
    if (d.at("m.torque_unique").values[k] == 1) CHECK(torque[k] == Approx(truth).epsilon(0).margin(1e-3));
    if (motion != and_back && std::abs(t - 0.5) > 1e-9) CHECK(d.at("m.torque_unique").values[k] == 1);
  }
}

}  // namespace

TEST_CASE("a table's point in a flat pose that it passes or turns round in is none to the motion") {
  for (const std::string& motion : {through, and_back})
    for (const bool deploys : {true, false})
      for (const std::vector<std::string>& how :
           std::vector<std::vector<std::string>>{{"solver.stages=3"},
                                                 {"solver.stages=4"},
                                                 {"solver.step=0.0037"},
                                                 {"solver.step=0.02", "solver.stages=5"},
                                                 {"solver.step=0.001"},
                                                 {"solver.step=0.02", "solver.adaptive=true"},
                                                 {"solver.method=\"rk4_projected\""}}) {
        // Order 4 is not enough beside the turn.
        if (motion == and_back && how.front().ends_with("projected\"")) continue;
        const Simulation run = run_scene(linkage(motion, "", "", deploys ? deployment : "\n"), how);
        CAPTURE(motion, deploys, how, run.message);
        check(run, motion);
        check_torque(run, motion);
      }
}

namespace {

// Of a payload that hangs from the second leg's end by a rod without mass and is pulled from 0.5 s on: its
// angle and rate at the end.
Eigen::Vector2d swung(double pull, double end) {
  using Pair = Eigen::Vector2d;
  constexpr double length = 0.5, mass = 0.5;
  const auto slope = [&](double t, bool pulled, const Pair& y) {
    const Led is = led(at_once, t);
    const double ax = -std::sin(is.a) * is.dda - std::cos(is.a) * is.da * is.da,
                 az = std::cos(is.a) * is.dda - std::sin(is.a) * is.da * is.da;
    const double aside = (pulled ? pull : 0) / mass - ax;
    return Pair(y[1], (aside * std::cos(y[0]) - (az + weight) * std::sin(y[0])) / length);
  };
  Pair y(0, 0);
  constexpr int steps = 2000;  // Runge-Kutta's, off by (4.4 / 2000)^4 or so
  for (const bool pulled : {false, true}) {
    const double from = pulled ? 0.5 : 0, h = (pulled ? end - 0.5 : 0.5) / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = from + i * h;
      const Pair a = slope(t, pulled, y), b = slope(t + h / 2, pulled, y + h / 2 * a),
                 c = slope(t + h / 2, pulled, y + h / 2 * b), d = slope(t + h, pulled, y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
  }
  return y;
}

const std::string hanging = R"(, {name = "K", position = [1.2, 0, "=sin(60*deg)-0.5"], mass = 0.5})",
                  beside = R"(, {name = "K", position = [4, 0, 0], mass = 1})";
// Of 2 N along x, all of it from 0.5 s on, or more and more.
std::string pulls(bool suddenly) {
  return std::string("[[forces]]\nkind = \"load_over_time\"\nnodes = [\"K\"]\nforce = [2, 0, 0]\n") +
         (suddenly ? "times = [0, 0.5, 0.5, 3]\nvalues = [0, 0, 1, 1]\n"
                   : "times = [0, 0.5, 1.5]\nvalues = [0, 0, 1]\n");
}

}  // namespace

// Two digits more than what the method leaves of such a swing in steps of 10 ms.
TEST_CASE("a load that begins as a drive leads through a flat pose pulls from then on") {
  const Eigen::Vector2d y = swung(2, 0.9);
  const double a = led(at_once, 0.9).a;
  const Vec3 at(0.7 + std::cos(a) + 0.5 * std::sin(y[0]), 0, std::sin(a) - 0.5 * std::cos(y[0]));
  for (const bool deploys : {true, false})
    for (const char* stages : {"solver.stages=4", "solver.stages=5"})
      for (const char* step : {"solver.step=0.01", "solver.step=0.0037", "solver.step=0.02"}) {
        const std::string more = deploys ? deployment : "\n";
        const Simulation falls = run_scene(linkage(at_once, beside, "", more) + pulls(true), {stages, step});
        CAPTURE(deploys, stages, step, falls.message);
        check(falls, at_once);
        check_torque(falls, at_once);
        const Vec3 fallen =
            testing::end_positions(falls).segment<3>(3 * static_cast<Index>(node(falls.trajectory, "K")));
        CHECK((fallen - Vec3(4 + 0.7 * 0.7, 0, -0.5 * weight * 1.44)).norm() < 1e-11);
        const Simulation run =
            run_scene(linkage(at_once, hanging, R"(, {nodes = ["B1", "K"], mass = 0})", more) + pulls(true),
                      {stages, step, "solver.end_time=0.9"});
        CAPTURE(run.message);
        check(run, at_once);
        const Vec3 is =
            testing::end_positions(run).segment<3>(3 * static_cast<Index>(node(run.trajectory, "K")));
        CHECK((is - at).norm() < 1e-7);
      }
}

namespace {

// A body of 1 kg on a line beside the linkage, and when it is where.
struct Beside {
  const char* what;
  double speed;
  std::string more;
  double (*at)(double t);
  bool told_with_pose = true;
};
const std::string on_stop =
    "[[constraints]]\nkind = \"coordinate_stop\"\nname = \"s\"\nnodes = [\"K\"]\n"
    "direction = [1, 0, 0]\nmax = 4.5\n";
const std::array<Beside, 4> besides{{
    {"a stop", 1, on_stop, [](double t) { return std::min(4 + t, 4.5); }},
    {"a bounce", 1, on_stop + "restitution = 0.5\n",
     [](double t) { return t < 0.5 ? 4 + t : 4.5 - 0.5 * (t - 0.5); }},
    // 2 m/s less 4 m/s^2.
    {"friction", 2, "[[forces]]\nkind = \"friction\"\nnodes = [\"K\"]\ndirection = [1, 0, 0]\nkinetic = 4\n",
     [](double t) { return t < 0.5 ? 4 + 2 * t - 2 * t * t : 4.5; }, false},
    // sqrt(100 / 1) rad/s.
    {"a cable", 1,
     "[[forces]]\nkind = \"spring\"\nnodes = [\"X\", \"K\"]\nstiffness = 100\nfree_length = 5.5\n"
     "tension_only = true\n",
     [](double t) {
       const double u = t - 0.5;
       return u < 0 ? 4 - t : u < pi / 10 ? 3.5 - 0.1 * std::sin(10 * u) : 3.5 + (u - pi / 10);
     }},
}};

}  // namespace

// What a body of its own does is no matter of the linkage, and the other way round. Three stages leave 1e-7
// of the swing on the cable.
TEST_CASE("what switches as a drive leads through a flat pose switches then") {
  for (const Beside& beside_it : besides)
    for (const bool deploys : {true, false}) {
      if (deploys && !beside_it.told_with_pose) continue;
      for (const std::vector<std::string>& how :
           std::vector<std::vector<std::string>>{{"solver.stages=3"},
                                                 {"solver.stages=4"},
                                                 {"solver.step=0.0037"},
                                                 {"solver.step=0.02", "solver.stages=5"}}) {
        const double speed = beside_it.what[2] == 'c' ? -beside_it.speed : beside_it.speed;
        const std::string k = R"(, {name = "K", position = [4, 0, 0], mass = 1, velocity = [)" +
                              std::to_string(speed) + ", 0, 0]}",
                          line = "[[constraints]]\nkind = \"line\"\nnodes = [\"K\"]\ndirection = [1, 0, 0]\n";
        const Simulation run =
            run_scene(linkage(at_once, k, "", deploys ? deployment : "\n") + line + beside_it.more, how);
        CAPTURE(beside_it.what, deploys, how, run.message);
        check(run, at_once);
        check_torque(run, at_once);
        const auto i = 3 * static_cast<Index>(node(run.trajectory, "K"));
        double most = 0;
        for (std::size_t n = 0; n < run.trajectory.size(); ++n)
          most = std::max(
              most, std::abs(run.trajectory.node_positions(n)[i] - beside_it.at(run.trajectory.time(n))));
        CHECK(most < 2e-7);
        CHECK(testing::largest(diagnose(run), "energy_balance_J") < 1e-5);
      }
    }
}

TEST_CASE("a run that ends as a drive leads through a flat pose ends in it") {
  for (const bool deploys : {true, false})
    for (const char* step : {"solver.step=0.01", "solver.step=0.0037", "solver.step=0.02"}) {
      const Simulation run =
          run_scene(linkage(at_once, "", "", deploys ? deployment : "\n"), {step, "solver.end_time=0.5"});
      CAPTURE(deploys, step, run.message);
      CHECK(run.trajectory.end_time() == 0.5);
      check(run, at_once);
      check_torque(run, at_once);
    }
}

// Asked for, archived there or not, and then gone on from to the same bits.
TEST_CASE("a state in a flat pose that a drive leads through is given where it is asked for") {
  const std::string text = linkage(at_once, beside) + pulls(false);
  const Scene scene = read_scene_text(text, "s.toml");
  const auto model = build_model(scene);
  Stepper whole(model, scene.solver);
  REQUIRE(whole.advance_to(0.5));
  CHECK(whole.time() == 0.5);
  const Off there = off(whole.run().trajectory, at_once);
  CHECK(there.place < 1e-9);
  CHECK(there.rate < 1e-7);
  whole.take_window(10);
  Archive archive;
  whole.archive(archive);
  Archive read(archive.bytes());
  Stepper again(model, scene.solver, read);
  for (Stepper* stepper : {&whole, &again}) {
    while (stepper->step()) {
    }
    CHECK(stepper->run().status == RunStatus::completed);
    const Off is = off(stepper->run().trajectory, at_once);
    CHECK(is.place < 1e-9);
    CHECK(is.rate < 1e-7);
  }
  CHECK(whole.state().z == again.state().z);
  CHECK(whole.state().w == again.state().w);
}

namespace {

// A body of 1 kg on a line beside the linkage that is stopped, or held back, from 0.5 s less `left` on.
struct Stopped {
  std::string scene;
  double place, rate;  // of the body at 0.5 s
};
Stopped stopped(int how, double left) {
  const double at = 0.5 - left, speed = how == 1 ? 4 * at : how == 2 ? -1 : 1;
  const std::string k =
      R"(, {name = "K", position = [4, 0, 0], mass = 1, velocity = [)" + testing::number(speed) + ", 0, 0]}";
  const std::array<std::string, 3> by{
      "[[constraints]]\nkind = \"coordinate_stop\"\nnodes = [\"K\"]\ndirection = [1, 0, 0]\nmax = " +
          testing::number(4 + at) + "\n",
      "[[forces]]\nkind = \"friction\"\nnodes = [\"K\"]\ndirection = [1, 0, 0]\nkinetic = 4\n",
      "[[forces]]\nkind = \"spring\"\nnodes = [\"X\", \"K\"]\nstiffness = 100\ntension_only = true\n"
      "free_length = " +
          testing::number(5 + at) + "\n"};
  const std::string line = "[[constraints]]\nkind = \"line\"\nnodes = [\"K\"]\ndirection = [1, 0, 0]\n";
  Stopped out{linkage("times = [0, 0.5]\nvalues = [60, 0]", k) + line + by[static_cast<std::size_t>(how)],
              how == 0   ? 4 + at
              : how == 1 ? 4 + 2 * at * at
                         : 4 - at - 0.1 * std::sin(10 * left),
              how == 2 ? -std::cos(10 * left) : 0};
  return out;
}

}  // namespace

// The drive's torque there is that of its last acceleration. What rounding leaves of the rates of the last
// states, 1e-16 / sine^2, is divided by their distance in it.
TEST_CASE("what switches beside a drive before it comes to rest in a flat pose takes nothing from it") {
  const double torque = 2 * weight + 5.0 / 3 * 6 * start / 0.25;
  for (const int how : {0, 1, 2})
    for (const double left : {0.012, 0.004, 1e-3, 1e-4, 1e-6})
      for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
               {"solver.stages=3"}, {"solver.stages=4"}, {"solver.step=0.0037"}, {"solver.step=0.001"}})
        for (const char* then : {"stop", "pass"}) {
          // Friction within a thousandth of a step of the pose counts as in it.
          if (how == 1 && left < 1e-4) continue;
          std::vector<std::string> changes = options;
          changes.push_back("solver.at_deployed=\"" + std::string(then) + "\"");
          changes.push_back("solver.end_time=0.6");
          const auto& [scene, place, rate] = stopped(how, left);
          const Simulation run = run_scene(scene, changes);
          CAPTURE(how, left, changes, run.message);
          REQUIRE(run.status == (std::string(then) == "stop" ? RunStatus::deployed : RunStatus::completed));
          const Trajectory& t = run.trajectory;
          std::size_t there = 0;
          while (t.time(there) < 0.5) ++there;
          CHECK(t.time(there) == 0.5);
          const auto b = 3 * static_cast<Index>(node(t, "B1")), k = 3 * static_cast<Index>(node(t, "K"));
          for (const std::size_t i : {there, t.size() - 1}) {
            CHECK((Vec3(t.node_positions(i).segment<3>(b)) - Vec3(1.7, 0, 0)).norm() < 1e-8);
            CHECK(t.node_velocities(i).segment<3>(b).norm() < 1e-6);
          }
          CHECK(t.node_positions(there)[k] == Approx(place).epsilon(0).margin(1e-8));
          CHECK(t.node_velocities(there)[k] == Approx(rate).epsilon(0).margin(1e-6));
          if (std::string(then) != "stop") continue;
          const Diagnostics d = diagnose(run);
          if (d.at("m.torque_unique").values.back() == 1)
            CHECK(d.at("m.torque_N_m").values.back() == Approx(torque).epsilon(0).margin(0.01));
        }
}

// What is interpolated in time up to there has the digits of states a step and more before. A body beside it
// falls as it did.
TEST_CASE("what a drive lays flat and holds rests there although no deployed pose is asked for") {
  const std::string table = "times = [0, 0.5]\nvalues = [60, 0]";
  for (const bool smooth : {false, true})
    for (const std::vector<std::string>& how :
         std::vector<std::vector<std::string>>{{"solver.stages=3"},
                                               {"solver.stages=4"},
                                               {"solver.step=0.0037"},
                                               {"solver.step=0.02", "solver.stages=5"},
                                               {"solver.step=0.005", "solver.stages=3"},
                                               {"solver.step=0.001"}}) {
      std::string text = linkage(table, beside, "", "\n");
      if (smooth)
        text.replace(text.find("motion = \"table\"\n" + table), 17 + table.size(),
                     "motion = \"smooth\"\nto = 0\nduration = 0.5");
      const Simulation run = run_scene(text, how);
      CAPTURE(smooth, how, run.message);
      REQUIRE(run.status == RunStatus::completed);
      const Trajectory& t = run.trajectory;
      const auto b = 3 * static_cast<Index>(node(t, "B1")), k = 3 * static_cast<Index>(node(t, "K"));
      double place = 0, rate = 0;
      for (std::size_t i = 0; i < t.size(); ++i) {
        if (t.time(i) < 0.5) continue;
        place = std::max(place, (Vec3(t.node_positions(i).segment<3>(b)) - Vec3(1.7, 0, 0)).norm());
        rate = std::max(rate, t.node_velocities(i).segment<3>(b).norm());
      }
      CHECK(place < 1e-7);
      CHECK(rate < 1e-9);
      CHECK(testing::end_positions(run)[k + 2] == Approx(-0.5 * weight * 1.44).epsilon(0).margin(1e-9));
      CHECK(
          std::ranges::none_of(run.events, [](const Event& event) { return event.kind == "singular_pose"; }));
    }
}

}  // namespace edge_in_flat_pose_test
