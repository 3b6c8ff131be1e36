// SPDX-License-Identifier: BSD-3-Clause
// Runs that go on from a flat pose, in which the constraints lose rank and where drives have come to rest.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/stepper.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::run_scene;

namespace held_flat_pose_test {

namespace {

constexpr double start = 60 * radians_per_degree, hanging = 0.5, weight = 9.81, led = 0.5, end = 0.8;

// Two legs and a coupler on pivots in one line, the first leg led from 60 degrees to 0 in half a second, and
// a payload that hangs from the second one's end.
std::string linkage(const std::string& motion) {
  return R"toml(
[structure]
kind = "custom"
nodes = [{name = "X", position = [9, 0, 0], fixed = true}, {name = "A0", position = [0, 0, 0], fixed = true},
  {name = "B0", position = ["=cos(60*deg)", 0, "=sin(60*deg)"]}, {name = "A1", position = [0.7, 0, 0], fixed = true},
  {name = "B1", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)"]},
  {name = "P", position = ["=0.7+cos(60*deg)", 0, "=sin(60*deg)-0.5"], mass = 0.5}]
rods = [{nodes = ["A0", "B0"], mass = 1}, {nodes = ["A1", "B1"], mass = 1}, {nodes = ["B0", "B1"], mass = 1},
  {nodes = ["B1", "P"], mass = 0}]
[[structure.constraints]]
kind = "plane"
nodes = ["B*", "P"]
normal = [0, 1, 0]
[gravity]
acceleration = [0, 0, -9.81]
[deployment]
measure = "angle X A0 B0 about 0 -1 0"
deployed = 0
[[constraints]]
kind = "angle"
name = "m"
nodes = ["X", "A0", "B0"]
axis = [0, -1, 0]
)toml" + motion +
         "\n[solver]\nend_time = 0.8\n";
}
const std::string table = "motion = \"table\"\ntimes = [0, 0.5]\nvalues = [60, 0]",
                  smooth = "motion = \"smooth\"\nduration = 0.5\nto = 0";

// Share, rate and acceleration at a share of the time: a spline without rates at its two points is a cubic.
Vec3 share(bool is_table, double u) {
  if (is_table) return {u * u * (3 - 2 * u), 6 * u * (1 - u), 6 - 12 * u};
  return {u * u * u * (10 - 15 * u + 6 * u * u), 30 * u * u * (1 - u) * (1 - u),
          60 * u * (1 - u) * (1 - 2 * u)};
}

// The payload's angle and rate at the end: a pendulum on a support that moves on the leg's circle, then
// rests.
Eigen::Vector2d swung(bool is_table) {
  using Pair = Eigen::Vector2d;
  bool rests = false;
  const auto slope = [&](double t, const Pair& y) {
    const Vec3 f = rests ? Vec3(1, 0, 0) : share(is_table, t / led);
    const double a = start * (1 - f[0]), da = -start * f[1] / led, dda = -start * f[2] / (led * led),
                 ax = -std::sin(a) * dda - std::cos(a) * da * da,
                 az = std::cos(a) * dda - std::sin(a) * da * da;
    return Pair(y[1], -(ax * std::cos(y[0]) + (az + weight) * std::sin(y[0])) / hanging);
  };
  Pair y(0, 0);
  constexpr int steps = 4000, driven = 2500;  // Runge-Kutta's of 0.2 ms, off by 1e-12 or so
  constexpr double h = led / driven;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    rests = i >= driven;
    const Pair a = slope(t, y), b = slope(t + h / 2, y + h / 2 * a), c = slope(t + h / 2, y + h / 2 * b),
               d = slope(t + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

Vec3 last(const Trajectory& t, const std::string& name, bool velocity = false) {
  const VectorXd of = velocity ? t.node_velocities(t.size() - 1) : t.node_positions(t.size() - 1);
  const auto& nodes = t.structure().nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].name == name) return of.segment<3>(3 * static_cast<Index>(i));
  return Vec3::Constant(std::nan(""));
}

struct How {
  const char* method;
  double step;
  int stages;
  double off;  // of the payload, by the method's order in steps of 1/200 to 1/20 of its swing of 1.4 s
};

}  // namespace

TEST_CASE(
    "what hangs from a linkage that a drive has laid flat swings on and the linkage rests by any method") {
  const std::vector<How> hows{{"dvm", 0.01, 4, 1e-6},
                              {"dvm", 0.0073, 5, 1e-7},
                              {"dvm", 0.02, 6, 1e-6},
                              {"dvm", 0.004, 3, 1e-4},
                              {"rk4", 0.004, 4, 1e-5},
                              {"rk4_projected", 0.004, 4, 1e-5},
                              {"rk4_baumgarte", 0.004, 4, 1e-4},
                              {"generalized_alpha", 0.004, 4, 4e-3}};
  for (const bool is_table : {true, false})
    for (std::size_t i = 0; i < hows.size(); ++i) {
      if (!is_table && i % 3 != 0) continue;
      const How& how = hows[i];
      const std::string then = i % 2 == is_table ? "pass" : "latch";
      const Simulation run = run_scene(
          linkage(is_table ? table : smooth),
          {"solver.at_deployed=\"" + then + "\"", std::string("solver.method=\"") + how.method + "\"",
           "solver.step=" + std::to_string(how.step), "solver.stages=" + std::to_string(how.stages)});
      CAPTURE(is_table, then, how.method, how.step, run.message);
      REQUIRE(run.status == RunStatus::completed);
      REQUIRE(run.events.front().kind == "deployed");
      CHECK(run.events.front().t == Approx(led).epsilon(1e-14));
      // Rounding in the rods' lengths turns them by 1e-16 over the sine of the poses that tell.
      CHECK((last(run.trajectory, "B1") - Vec3(1.7, 0, 0)).norm() < 1e-8);
      CHECK(last(run.trajectory, "B1", true).norm() == 0);
      const Eigen::Vector2d y = swung(is_table);
      const Vec3 at(1.7 + hanging * std::sin(y[0]), 0, -hanging * std::cos(y[0]));
      CHECK((last(run.trajectory, "P") - at).norm() < how.off);
      if (i > 0) continue;
      // A pendulum's pull is no matter of the legs, whose forces have no bound.
      const Diagnostics of = diagnose(run);
      const double pull = 0.5 * (weight * std::cos(y[0]) + hanging * y[1] * y[1]);
      CHECK(of.axial_force(of.axial_force.rows() - 1, 3) == Approx(pull).epsilon(100 * how.off));
    }
}

// Loads that the limbs bear without a bound go on being borne: 12 hinges of 200 N do 7200 J per radian of the
// mean fold angle in the flat pose, 3 m each, and each post takes one hinge's load from above and from below.
TEST_CASE("a ring that a drive has laid flat rests under its loads and its forces are those of statics") {
  const Simulation run = run_scene(R"(
[structure]
kind = "hoop"
units = 6
fold_angle = 50
hinge_force = 200
[[constraints]]
kind = "angle"
name = "m"
fold_angle = true
motion = "smooth"
to = 0
duration = 0.8
[solver]
step = 0.01
stages = 4
end_time = 1.2
at_deployed = "pass")");
  CAPTURE(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const Trajectory& t = run.trajectory;
  CHECK(t.node_velocities(t.size() - 1).lpNorm<Eigen::Infinity>() < 1e-7);
  const Diagnostics of = diagnose(run);
  CHECK(of.at("axial_force_max_N").values.back() == Approx(200).epsilon(1e-6));
}

TEST_CASE("a run that is archived in a flat pose that a drive holds goes on in it") {
  const Scene scene = read_scene_text(linkage(table), "s.toml", {"solver.at_deployed=\"pass\""});
  const auto model = build_model(scene);
  Stepper whole(model, scene.solver);
  REQUIRE(whole.advance_to(0.6, {}));
  Archive kept;
  whole.archive(kept);
  Archive read(kept.bytes());
  Stepper rest(model, scene.solver, read);
  whole.advance_to(end, {});
  rest.advance_to(end, {});
  CHECK(rest.time() == end);
  CHECK((rest.state().z - whole.state().z).norm() < 1e-12);
}

}  // namespace held_flat_pose_test
