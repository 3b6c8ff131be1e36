// SPDX-License-Identifier: BSD-3-Clause
// Linkages that drives lay flat for good without a [deployment] that says so: as they come to rest there, one
// after the other, and with something that strikes a stop just before.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/simulate/simulation.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::run_scene;

namespace laid_flat_test {

namespace {

// Two legs of 1 m and a coupler on pivots in one line, the first leg led from 60 degrees to 0.
std::string linkage(const std::string& p, double depth, double start, double duration) {
  const std::string z = std::to_string(depth), top = "\"=" + z + "+sin(60*deg)\"";
  const auto node = [&](const std::string& name, const std::string& x, const std::string& at, bool fixed) {
    return "[[structure.nodes]]\nname = \"" + p + name + "\"\nposition = [" + x + ", 0, " + at + "]\n" +
           (fixed ? "fixed = true\n" : "");
  };
  std::string out = node("X", "9", z, true) + node("A", "0", z, true) + node("C", "0.7", z, true) +
                    node("B", "0.5", top, false) + node("D", "1.2", top, false);
  for (const char* ends : {"AB", "CD", "BD"})
    out += "[[structure.rods]]\nmass = 1\nnodes = [\"" + p + ends[0] + "\", \"" + p + ends[1] + "\"]\n";
  return out + "[[constraints]]\nkind = \"plane\"\nnodes = [\"" + p + "B\", \"" + p +
         "D\"]\nnormal = [0, 1, 0]\n[[constraints]]\nkind = \"angle\"\nname = \"" + p + "\"\nnodes = [\"" +
         p + "X\", \"" + p + "A\", \"" + p +
         "B\"]\naxis = [0, -1, 0]\nmotion = \"smooth\"\nto = 0\nstart = " + std::to_string(start) +
         "\nduration = " + std::to_string(duration) + "\n";
}

// How far the legs' ends are from where they are led, in a state, and by their rates in a hundredth of a
// second.
double off(const Trajectory& run, std::size_t i, const std::string& p, double start, double duration) {
  const double u = std::clamp((run.time(i) - start) / duration, 0.0, 1.0),
               a = 60 * radians_per_degree * (1 - u * u * u * (10 - 15 * u + 6 * u * u)),
               rate = -60 * radians_per_degree * 30 * u * u * (1 - u) * (1 - u) / duration;
  const VectorXd q = run.node_positions(i), v = run.node_velocities(i);
  double most = 0;
  for (std::size_t n = 0; n < run.structure().nodes.size(); ++n) {
    const std::string& name = run.structure().nodes[n].name;
    if (name != p + "B" && name != p + "D") continue;
    const Vec3 pivot = run.structure().nodes[n - 2].position;
    const auto at = 3 * static_cast<Index>(n);
    most = std::max(most, (q.segment<3>(at) - pivot - Vec3(std::cos(a), 0, std::sin(a))).norm());
    most = std::max(most, 0.01 * (v.segment<3>(at) - rate * Vec3(-std::sin(a), 0, std::cos(a))).norm());
  }
  return most;
}

// Behind the last step that rounding leaves its digits it is interpolated, to 1e-8 of the structure's 9 m.
constexpr double told = 1e-7;

std::vector<std::string> of(int stages, double step, double end) {
  return {"solver.stages=" + std::to_string(stages), "solver.step=" + std::to_string(step),
          "solver.end_time=" + std::to_string(end)};
}

const std::string custom = "[structure]\nkind = \"custom\"\n",
                  weight = "[gravity]\nacceleration = [0, 0, -9.81]\n";

}  // namespace

TEST_CASE("every state of a linkage that a drive lays flat for good is where it is led by any step") {
  struct How {
    int stages;
    double step, duration;
  };
  // Durations of random scenes; most of these runs had rates that were off by 1e-3 or ended with an error.
  for (const How& how :
       {How{4, 0.002, 0.4775}, How{5, 0.005, 0.9314}, How{6, 0.01, 1.0602}, How{6, 0.005, 1.081},
        How{3, 0.0037, 1.27}, How{8, 0.02, 0.5802}, How{4, 0.02, 0.7621}}) {
    CAPTURE(how.stages, how.step, how.duration);
    const Simulation run = run_scene(custom + linkage("P", 0, 0, how.duration) + weight,
                                     of(how.stages, how.step, how.duration + 0.1));
    REQUIRE(run.status == RunStatus::completed);
    for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
      CHECK(off(run.trajectory, i, "P", 0, how.duration) < told);
      if (i > 0) CHECK(run.trajectory.time(i) - run.trajectory.time(i - 1) < 1.001 * how.step);
    }
  }
}

TEST_CASE("linkages that are laid flat one after the other rest whichever of them is the deployed one") {
  // A ball on a spring of 2 rad / s beside them strikes a stop 1 ms before the first rests: x = A sin(2 t).
  const double hit = 0.499, place = 0.1 * std::sin(2 * hit);
  const std::string ball = R"toml(
[[structure.nodes]]
name = "F"
position = [5, 5, 0]
fixed = true
[[structure.nodes]]
name = "K"
position = [3, 5, 0]
velocity = [0.2, 0, 0]
mass = 1
[[constraints]]
kind = "line"
nodes = ["K"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["K", "F"]
stiffness = 4
[[constraints]]
kind = "coordinate_stop"
nodes = ["F", "K"]
direction = [1, 0, 0]
restitution = 1
max = )toml" + std::to_string(place - 2) +
                           "\n",
                    two = linkage("P", 0, 0, 0.5) + linkage("Q", -3, 0.2, 0.5);
  for (const char* deployed : {"", "P", "Q"})
    for (const int stages : {4, 5, 6}) {
      const std::string p = deployed;
      CAPTURE(p, stages);
      const std::string measure = p.empty() ? ""
                                            : "[deployment]\ndeployed = 0\nmeasure = \"angle " + p + "X " +
                                                  p + "A " + p + "B about 0 -1 0\"\n";
      std::vector<std::string> how = of(stages, 0.01, 0.8);
      if (!p.empty()) how.emplace_back("solver.at_deployed=\"pass\"");
      const Simulation run = run_scene(custom + two + ball + weight + measure, how);
      REQUIRE(run.status == RunStatus::completed);
      for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
        CHECK(off(run.trajectory, i, "P", 0, 0.5) < told);
        CHECK(off(run.trajectory, i, "Q", 0.2, 0.5) < told);
      }
      const auto& nodes = run.trajectory.structure().nodes;
      const auto k = std::ranges::find(nodes, "K", &Node::name) - nodes.begin();
      const std::size_t last = run.trajectory.size() - 1;
      const double after = 2 * (run.trajectory.time(last) - hit), speed = 0.2 * std::cos(2 * hit);
      // The stop's place has six digits; so has the time.
      CHECK(run.trajectory.node_positions(last)[3 * k] ==
            Approx(3 + place * std::cos(after) - speed / 2 * std::sin(after)).epsilon(0).margin(1e-5));
    }
}

}  // namespace laid_flat_test
