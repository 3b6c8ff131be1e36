// SPDX-License-Identifier: BSD-3-Clause
// What swings, rests or switches beside a drive that leads a linkage through its flat pose, where the
// constraints lose rank, has nothing to do with that pose.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace beside_flat_pose_test {

namespace {

using testing::number;
using testing::run_scene;

// A text with these for < and > and ^.
std::string with_names(std::string text, char a, char b, char y) {
  for (char& c : text) c = c == '<' ? a : c == '>' ? b : c == '^' ? y : c;
  return text;
}

constexpr double start = 60 * radians_per_degree, weight = 9.81;

// Two legs and a coupler of 1 m and 1 kg on pivots in one line, at y; the first leg is led from 60 degrees.
std::string nodes_at(char y, char a, char b) {
  return with_names(R"toml({name = "X<", position = [9, ^, 0], fixed = true},
  {name = "<0", position = [0, ^, 0], fixed = true}, {name = ">0", position = [0.5, ^, "=sin(60*deg)"]},
  {name = "<1", position = [0.7, ^, 0], fixed = true}, {name = ">1", position = [1.2, ^, "=sin(60*deg)"]})toml",
                    a, b, y);
}
std::string rods_of(char a, char b) {
  return with_names(R"({nodes = ["<0", ">0"], mass = 1}, {nodes = ["<1", ">1"], mass = 1},
  {nodes = [">0", ">1"], mass = 1})",
                    a, b, '0');
}
std::string drive_of(char a, char b, const std::string& motion) {
  return with_names(R"([[constraints]]
kind = "plane"
nodes = [">*"]
normal = [0, 1, 0]
[[constraints]]
kind = "angle"
name = "m<"
nodes = ["X<", "<0", ">0"]
axis = [0, -1, 0]
)",
                    a, b, '0') +
         motion;
}
std::string scene(const std::string& motion, bool deploys, const std::string& nodes, const std::string& rods,
                  const std::string& more) {
  std::string text = "[structure]\nkind = \"custom\"\nnodes = [" + nodes_at('0', 'A', 'B') + nodes +
                     "]\nrods = [" + rods_of('A', 'B') + rods +
                     "]\n[gravity]\nacceleration = [0, 0, -9.81]\n" + drive_of('A', 'B', motion) + more;
  if (deploys)
    text += R"([deployment]
measure = "angle XA A0 B0 about 0 -1 0"
deployed = 0
)";
  return text + "[solver]\nstep = 0.01\nstages = 4\nend_time = 1.2\n" +
         (deploys ? "at_deployed = \"pass\"\n" : "");
}

struct Led {
  double a, da, dda;
};
// From 60 degrees to another angle in some time, at rest in both: a cubic, as a clamped spline is through its
// middle.
Led cubic(double to, double t, double duration) {
  const double u = t / duration, way = to - start;
  if (u >= 1) return {to, 0, 0};
  return {start + way * u * u * (3 - 2 * u), way * 6 * u * (1 - u) / duration,
          way * (6 - 12 * u) / duration / duration};
}
std::string through(double duration) {
  return "motion = \"table\"\ntimes = [0, " + number(duration / 2) + ", " + number(duration) +
         "]\nvalues = [60, 0, -60]\n";
}
const std::string laid_flat = "motion = \"table\"\ntimes = [0, 0.5]\nvalues = [60, 0]\n";

Index node(const Trajectory& t, const std::string& name) {
  Index i = 0;
  while (t.structure().nodes[static_cast<std::size_t>(i)].name != name) ++i;
  return 3 * i;
}

// Of the second leg's end, in all states: how far it is off and its rate, in a step.
double off(const Trajectory& run, const std::string& name, double to, double duration) {
  double most = 0;
  const Index i = node(run, name);
  for (std::size_t k = 0; k < run.size(); ++k) {
    const Led is = cubic(to, run.time(k), duration);
    const Vec3 at(0.7 + std::cos(is.a), run.node_positions(0)[i + 1], std::sin(is.a)),
        rate(-std::sin(is.a) * is.da, 0, std::cos(is.a) * is.da);
    most = std::max({most, (Vec3(run.node_positions(k).segment<3>(i)) - at).norm(),
                     0.01 * (Vec3(run.node_velocities(k).segment<3>(i)) - rate).norm()});
  }
  return most;
}

const std::string line = "[[constraints]]\nkind = \"line\"\nnodes = [\"K\"]\ndirection = [1, 0, 0]\n";
std::string body(double speed) {
  return R"(, {name = "K", position = [4, 0, 0], mass = 1, velocity = [)" + number(speed) + ", 0, 0]}";
}

}  // namespace

// Two rods nearly in line, whose rows are as weak as those of the linkage next to its pose, and stay so. What
// a linkage alone leaves of its way is 3e-9 m.
TEST_CASE("a drive leads through a flat pose beside a truss that rests near a flat pose of its own") {
  for (const bool deploys : {false, true})
    for (const char* height : {"0.05", "0.005", "3e-4"})
      for (const std::vector<std::string>& how : std::vector<std::vector<std::string>>{
               {"solver.step=0.01"}, {"solver.step=0.0037"}, {"solver.step=0.01", "solver.stages=3"}}) {
        CAPTURE(deploys, height, how);
        const Simulation run = run_scene(
            scene(
                through(1), deploys,
                ", {name = \"T0\", position = [0, 5, 0], fixed = true}, {name = \"T1\", position = [1, 5, -" +
                    std::string(height) + "]}, {name = \"T2\", position = [2, 5, 0], fixed = true}",
                ", {nodes = [\"T0\", \"T1\"], mass = 1}, {nodes = [\"T1\", \"T2\"], mass = 1}",
                "[[constraints]]\nkind = \"plane\"\nnodes = [\"T1\"]\nnormal = [0, 1, 0]\n"),
            how);
        CAPTURE(run.message);
        CHECK(run.status == RunStatus::completed);
        CHECK(off(run.trajectory, "B1", -start, 1) < 1e-7);
      }
}

// The pose is told by states some steps apart, which tell nothing of a swing of twelve steps. What the method
// itself leaves of it is 1e-7 of 0.1 m.
TEST_CASE("what swings fast beside a drive that slowly passes a flat pose goes on swinging") {
  constexpr double omega = 100, size = 0.1, duration = 12;
  for (const bool deploys : {false, true}) {
    const Simulation run =
        run_scene(scene(through(duration), deploys, body(size * omega), "",
                        line + "[[forces]]\nkind = \"spring\"\nnodes = [\"XA\", \"K\"]\nstiffness = 1e4\n"),
                  {"solver.step=0.002", "solver.end_time=7"});
    CAPTURE(deploys, run.message);
    REQUIRE(run.status == RunStatus::completed);
    double most = 0;
    const Trajectory& t = run.trajectory;
    for (std::size_t k = 0; k < t.size(); ++k)
      most = std::max(most,
                      std::abs(t.node_positions(k)[node(t, "K")] - 4 - size * std::sin(omega * t.time(k))));
    CHECK(most < 1e-6);
    CHECK(off(t, "B1", -start, duration) < 1e-8);
    CHECK(testing::largest(diagnose(run), "energy_balance_J") < 1e-6);
  }
}

// 3e-3 of a step are 1e-4 rad; nearer to the pose rounding says its rates.
TEST_CASE(
    "a stop that is met shortly before a drive passes a point of its table in a flat pose is no part of it") {
  for (const bool deploys : {false, true})
    for (const double left : {0.3, 0.012, 0.004, 1e-3, 1e-4, 1e-5, 1e-7})
      for (const char* step : {"solver.step=0.01", "solver.step=0.0037"}) {
        const std::string stop =
            "[[constraints]]\nkind = \"coordinate_stop\"\nname = \"s\"\nnodes = [\"K\"]\n"
            "direction = [1, 0, 0]\nmax = " +
            number(4.5 - left) + "\n";
        const Simulation run = run_scene(scene(through(1), deploys, body(1), "", line + stop), {step});
        CAPTURE(deploys, left, step, run.message);
        REQUIRE(run.status == RunStatus::completed);
        CHECK(off(run.trajectory, "B1", -start, 1) < 1e-8);
        const Diagnostics d = diagnose(run);
        CHECK(testing::largest(d, "energy_balance_J") < 1e-4);
        for (std::size_t k = 0; k < run.trajectory.size(); ++k) {
          const double t = run.trajectory.time(k);
          const Led is = cubic(-start, t, 1);
          if (d.at("mA.torque_unique").values[k] == 1 && std::abs(t - 1) > 1e-9)
            CHECK(d.at("mA.torque_N_m").values[k] ==
                  Approx(5.0 / 3 * is.dda + 2 * weight * std::cos(is.a)).epsilon(0).margin(2e-3));
        }
      }
}

// The run's own grid may bring a state within the same pose as the load's.
TEST_CASE("a load that begins next to the flat pose that a drive passes at speed pulls from then on") {
  for (const bool deploys : {false, true})
    for (const double from : {0.499999, 0.49999999})
      for (const char* step : {"solver.step=0.01", "solver.step=0.0037"}) {
        const std::string load =
            "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"K\"]\nforce = [2, 0, 0]\n"
            "times = [0, " +
            number(from) + ", " + number(from) + ", 3]\nvalues = [0, 0, 1, 1]\n";
        const Simulation run = run_scene(scene("motion = \"table\"\ntimes = [0, 1]\nvalues = [60, -60]\n",
                                               deploys, body(0), "", line + load),
                                         {step});
        CAPTURE(deploys, from, step, run.message);
        REQUIRE(run.status == RunStatus::completed);
        CHECK(off(run.trajectory, "B1", -start, 1) < 1e-8);
        CHECK(testing::end_positions(run)[node(run.trajectory, "K")] ==
              Approx(4 + (1.2 - from) * (1.2 - from)).epsilon(0).margin(1e-11));
        CHECK(testing::largest(diagnose(run), "energy_balance_J") < 1e-4);
      }
}

TEST_CASE("a linkage passes its flat pose as another one is laid flat for good") {
  for (const bool deploys : {false, true})
    for (const char* step : {"solver.step=0.01", "solver.step=0.0037"}) {
      const Simulation run =
          run_scene(scene(laid_flat, deploys, ", " + nodes_at('2', 'C', 'D'), ", " + rods_of('C', 'D'),
                          drive_of('C', 'D', "motion = \"table\"\ntimes = [0, 1]\nvalues = [60, -60]\n")),
                    {step});
      CAPTURE(deploys, step, run.message);
      REQUIRE(run.status == RunStatus::completed);
      CHECK(off(run.trajectory, "D1", -start, 1) < 1e-8);
      CHECK(off(run.trajectory, "B1", 0, 0.5) < 1e-8);
      CHECK(testing::largest(diagnose(run), "energy_balance_J") < 1e-4);
    }
}

// The one slows down by a polynomial of degree five, the other passes at speed. What the other leaves of its
// way is 5e-9 m, in a run by itself.
TEST_CASE("a linkage passes its flat pose at the time at which another one has come to rest in its own") {
  for (const std::vector<std::string>& how :
       std::vector<std::vector<std::string>>{{"solver.step=0.02"},
                                             {"solver.step=0.01", "solver.stages=5"},
                                             {"solver.step=0.01", "solver.stages=3"}}) {
    const Simulation run = run_scene(
        scene("motion = \"smooth\"\nto = 0\nduration = 0.5\n", false, ", " + nodes_at('2', 'C', 'D'),
              ", " + rods_of('C', 'D'), drive_of('C', 'D', through(1))),
        how);
    CAPTURE(how, run.message);
    REQUIRE(run.status == RunStatus::completed);
    CHECK(off(run.trajectory, "D1", -start, 1) < 1e-7);
    for (std::size_t k = 0; k < run.trajectory.size(); ++k)
      if (run.trajectory.time(k) >= 0.5)
        CHECK((run.trajectory.node_positions(k).segment<3>(node(run.trajectory, "B1")) - Vec3(1.7, 0, 0))
                  .norm() < 1e-7);
  }
}

// Where a drive comes to rest slowly, steps next to the pose are of rounding: 1e-2 m/s at 3e-6 rad. A load
// beside it may begin there all the same.
TEST_CASE("on the way to rest in a flat pose no state is one of rounding, whatever begins beside it") {
  for (const double from : {0.975, 0.98, 0.985, 0.993})
    for (const std::vector<std::string>& how : std::vector<std::vector<std::string>>{
             {"solver.step=0.01"}, {"solver.step=0.0037", "solver.stages=3"}, {"solver.step=0.004"}}) {
      const std::string load =
          "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"K\"]\nforce = [2, 0, 0]\n"
          "times = [0, " +
          number(from) + ", " + number(from) + ", 3]\nvalues = [0, 0, 1, 1]\n";
      const Simulation run = run_scene(
          scene("motion = \"smooth\"\nduration = 1\nto = 0\n", true, body(0), "", line + load), how);
      CAPTURE(from, how, run.message);
      REQUIRE(run.status == RunStatus::completed);
      const Trajectory& t = run.trajectory;
      const Index i = node(t, "B1");
      double place = 0, rate = 0;
      for (std::size_t k = 0; k < t.size(); ++k) {
        const double u = std::min(t.time(k), 1.0), a = start * (1 - u * u * u * (10 - 15 * u + 6 * u * u)),
                     da = -start * 30 * u * u * (1 - u) * (1 - u);
        place = std::max(
            place,
            (Vec3(t.node_positions(k).segment<3>(i)) - Vec3(0.7 + std::cos(a), 0, std::sin(a))).norm());
        rate = std::max(
            rate,
            (Vec3(t.node_velocities(k).segment<3>(i)) - da * Vec3(-std::sin(a), 0, std::cos(a))).norm());
        if (k > 0) CHECK(t.time(k) >= t.time(k - 1));
      }
      CHECK(place < 1e-8);
      CHECK(rate < 1e-6);
      CHECK(testing::end_positions(run)[node(t, "K")] ==
            Approx(4 + (1.2 - from) * (1.2 - from)).epsilon(0).margin(1e-11));
    }
}

namespace {

constexpr double payload = 0.5, hanging = 0.3, pull = 3;

// Angle, rate and acceleration of a payload that hangs from the second leg's end, as the drive has laid that
// flat; it is pulled down aside by a load from `from` on.
Vec3 swung(double from) {
  using Pair = Eigen::Vector2d;
  const auto slope = [&](const Led& is, double force, const Pair& y) {
    const double ax = -std::sin(is.a) * is.dda - std::cos(is.a) * is.da * is.da,
                 az = std::cos(is.a) * is.dda - std::sin(is.a) * is.da * is.da;
    return Pair(y[1],
                ((force / payload - ax) * std::cos(y[0]) - (az + weight + force / payload) * std::sin(y[0])) /
                    hanging);
  };
  const auto led = [](double t) { return cubic(0, std::min(t, 0.5 - 1e-15), 0.5); };
  Pair y(0, 0);
  for (const bool pulled : {false, true}) {
    constexpr int steps = 2000;
    const double start_of = pulled ? from : 0, h = ((pulled ? 0.5 : from) - start_of) / steps,
                 force = pulled ? pull : 0;
    for (int i = 0; i < steps; ++i) {
      const double t = start_of + i * h;
      const Pair a = slope(led(t), force, y), b = slope(led(t + h / 2), force, y + h / 2 * a),
                 c = slope(led(t + h / 2), force, y + h / 2 * b), d = slope(led(t + h), force, y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
  }
  return {y[0], y[1], slope(led(0.5), pull, y)[1]};
}

}  // namespace

// By virtual work: legs, coupler and what the payload pulls its pin with.
TEST_CASE("a load that jumps on a payload just before its drive comes to rest in a flat pose is felt once") {
  for (const double left : {1e-2, 1e-4, 1e-6})
    for (const char* step : {"solver.step=0.01", "solver.step=0.005", "solver.step=0.0037"}) {
      const std::string from = number(0.5 - left),
                        load = "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"Bk\"]\nforce = [" +
                               number(pull) + ", 0, " + number(-pull) + "]\ntimes = [0, " + from + ", " +
                               from + ", 3]\nvalues = [0, 0, 1, 1]\n";
      const Simulation run =
          run_scene(scene(laid_flat, true,
                          R"(, {name = "Bk", position = [1.2, 0, )" + number(std::sin(start) - hanging) +
                              "], mass = " + number(payload) + "}",
                          R"(, {nodes = ["B1", "Bk"], mass = 0})", load),
                    {step, "solver.at_deployed=\"stop\""});
      CAPTURE(left, step, run.message);
      REQUIRE(run.status == RunStatus::deployed);
      const Vec3 y = swung(0.5 - left);
      const Led is = cubic(0, 0.5 - 1e-15, 0.5);
      const double lifts = is.dda + hanging * (std::sin(y[0]) * y[2] + std::cos(y[0]) * y[1] * y[1]);
      const Diagnostics d = diagnose(run);
      REQUIRE(d.at("mA.torque_unique").values.back() == 1);
      CHECK(
          d.at("mA.torque_N_m").values.back() ==
          Approx(5.0 / 3 * is.dda + 2 * weight + payload * (lifts + weight) + pull).epsilon(0).margin(1e-3));
    }
}

// The step that the jump ends can be solved or not, as rounding has it.
TEST_CASE("a step before a flat pose that a load's jump ends gets there whether it can be solved or not") {
  const std::string loads = R"([[forces]]
kind = "load_over_time"
nodes = ["B1"]
force = [0, 0, -1800]
times = [0, 0.4, 3]
values = [0, 0.17219246832667556, -0.5330865860631162]
[[forces]]
kind = "load_over_time"
nodes = ["Bk"]
force = [3, 0, -3]
times = [0, 0.4999, 0.4999, 3]
values = [1, 1, -0.9532465637795484, -0.13086052691714722]
)";
  for (const char* step : {"solver.step=0.005", "solver.step=0.0049", "solver.step=0.0051"}) {
    const Simulation run = run_scene(
        scene(laid_flat, true,
              R"(, {name = "Bk", position = [1.2, 0, )" + number(std::sin(start) - 0.5) + "], mass = 0.5}",
              R"(, {nodes = ["B1", "Bk"], mass = 0})", loads),
        {step, "solver.at_deployed=\"stop\""});
    CAPTURE(step, run.message);
    REQUIRE(run.status == RunStatus::deployed);
    CHECK(run.trajectory.end_time() == 0.5);
    CHECK(off(run.trajectory, "B1", 0, 0.5) < 1e-8);
  }
}

}  // namespace beside_flat_pose_test
