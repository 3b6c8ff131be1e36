// SPDX-License-Identifier: BSD-3-Clause
// Drives that rest or turn round a little before a dead centre of what they lead.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace beside_dead_centre_test {

namespace {

// Two rods O-A-E, E on the x axis, whose far end is `x` from O where A is `bend` rad off their line, on the
// side of positive y; stretched or folded together.
struct Toggle {
  double first, second;
  bool stretched;

  double x(double bend) const {
    return std::sqrt(first * first + second * second +
                     (stretched ? 2 : -2) * first * second * std::cos(bend));
  }
  // By twice the area of the triangle.
  double height(double bend) const { return first * second * std::sin(bend) / x(bend); }
  std::string scene(double bend, const std::string& name = "") const {
    const double end = x(bend), up = height(bend),
                 beside = (first * first - second * second + end * end) / (2 * end);
    const auto node = [&](const std::string& letter, double x, double y, const char* more) {
      return "[[structure.nodes]]\nname = \"" + letter + name + "\"\nposition = [" + testing::number(x) +
             ", " + testing::number(y) + ", 0]\n" + more;
    };
    const auto rod = [&](const char* a, const char* b) {
      return std::string("[[structure.rods]]\nnodes = [\"") + a + name + "\", \"" + b + name +
             "\"]\nmass = 1\n";
    };
    return node("O", 0, 0, "fixed = true\n") + node("A", beside, up, "") + node("E", end, 0, "mass = 0.5\n") +
           rod("O", "A") + rod("A", "E") + "[[constraints]]\nkind = \"plane\"\nnodes = [\"A" + name +
           "\"]\nnormal = [0, 0, 1]\n[[constraints]]\nkind = \"line\"\nnodes = [\"E" + name +
           "\"]\ndirection = [1, 0, 0]\n[[constraints]]\nkind = \"coordinate\"\nname = \"drive" + name +
           "\"\nnodes = [\"E" + name + "\"]\ndirection = [1, 0, 0]\n";
  }
};

const std::string begin = "[structure]\nkind = \"custom\"\n";
const Toggle stretched{1, 1.5, true}, folded{0.6, 1.4, false};

double height(const Simulation& run, std::size_t i, Index node = 1) {
  return run.trajectory.node_positions(i)[3 * node + 1];
}

}  // namespace

// A that sign for A's height where E rests is right to what rounds x over the bend, 2e-16 m / 2e-5 rad, and
// the methods leave of some 30 times that.
TEST_CASE("rods that a drive leads to just before their dead centre stay on their side of it") {
  for (const Toggle& toggle : {stretched, folded})
    for (const double rest : {3e-4, 2e-5})
      for (const auto& [method, step] : {std::pair{"stages=3", "0.05"},
                                         {"stages=3", "0.02"},
                                         {"stages=2", "0.02"},
                                         {"stages=4", "0.02"},
                                         {"constraints_at='ends'", "0.02"},
                                         {"adaptive=true", "0.02"}}) {
        INFO(toggle.stretched << ", " << rest << " rad, " << method << ", " << step);
        const Simulation run = testing::run_scene(
            begin + toggle.scene(1) + "motion = \"smooth\"\nto = " + testing::number(toggle.x(rest)) +
                "\nduration = 1\n[solver]\nend_time = 1.3\n",
            {std::string("solver.step=") + step, std::string("solver.") + method});
        CHECK(run.status == RunStatus::completed);
        for (std::size_t i = 0; i < run.trajectory.size(); ++i)
          CHECK(height(run, i) > 0.99 * toggle.height(rest));
        CHECK(height(run, run.trajectory.size() - 1) == Approx(toggle.height(rest)).epsilon(0).margin(1e-9));
      }
}

// Two rods so nearly in line that their rows are weaker than those of the linkage.
TEST_CASE("rods stay on their side of a dead centre beside a truss that is nearer to one of its own") {
  for (const Toggle& toggle : {stretched, folded})
    for (const char* step : {"0.05", "0.02"}) {
      constexpr double rest = 3e-4;
      INFO(toggle.stretched << ", " << step);
      const Simulation run = testing::run_scene(
          begin + toggle.scene(1) + "motion = \"smooth\"\nto = " + testing::number(toggle.x(rest)) +
              "\nduration = 1\n" + R"toml([[structure.nodes]]
name = "T0"
position = [0, 3, 0]
fixed = true
[[structure.nodes]]
name = "T1"
position = [1, 3, 1e-5]
[[structure.nodes]]
name = "T2"
position = [2, 3, 0]
fixed = true
[[structure.rods]]
nodes = ["T0", "T1"]
mass = 1
[[structure.rods]]
nodes = ["T1", "T2"]
mass = 1
[[constraints]]
kind = "plane"
nodes = ["T1"]
normal = [0, 1, 0]
[solver]
end_time = 1.3
)toml",
          {std::string("solver.step=") + step});
      CHECK(run.status == RunStatus::completed);
      for (std::size_t i = 0; i < run.trajectory.size(); ++i)
        CHECK(height(run, i) > 0.99 * toggle.height(rest));
    }
}

TEST_CASE("each of two linkages that drives lead to just before their dead centres stays on its side") {
  for (const char* step : {"0.05", "0.02"})
    for (const double more : {1.0, 1.4, 6.0}) {
      const double first = 1e-4, second = more * first;
      const std::string smooth = "motion = \"smooth\"\nduration = 1\nto = ";
      const Simulation run =
          testing::run_scene(begin + stretched.scene(1, "1") + smooth + testing::number(stretched.x(first)) +
                                 "\n" + folded.scene(0.8, "2") + smooth + testing::number(folded.x(second)) +
                                 "\n[solver]\nend_time = 1.3\n",
                             {std::string("solver.step=") + step});
      INFO(step << ", " << more);
      CHECK(run.status == RunStatus::completed);
      for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
        CHECK(height(run, i) > 0.99 * stretched.height(first));
        CHECK(height(run, i, 4) > 0.99 * folded.height(second));
      }
    }
}

// In three points a clamped spline that is 1 at t = 1 and 0 at rest at t = 0 and 3 has its top of 54/49 at t
// = 9/7: with u = (t - 1) / 2 it is 1 + 1.5 u - 6 u^2 + 3.5 u^3 there.
TEST_CASE(
    "rods turn back with a drive that turns round just before their dead centre and pass it with one in it") {
  for (const Toggle& toggle : {stretched, folded})
    for (const double turn : {3e-4, 0.0})
      for (const char* step : {"0.02", "0.01"})
        for (const bool inside : {false, true}) {
          INFO(toggle.stretched << ", " << turn << " rad, " << step
                                << (inside ? ", within a step" : ", at a point"));
          const double from = toggle.x(1), to = toggle.x(turn),
                       top = inside ? from + 49.0 / 54 * (to - from) : to;
          const Simulation run = testing::run_scene(
              begin + toggle.scene(1) + "motion = \"table\"\ntimes = [0, 1, " + (inside ? "3" : "2") +
                  "]\nvalues = [" + testing::number(from) + ", " + testing::number(top) + ", " +
                  testing::number(from) + "]\n[solver]\nend_time = 3\n",
              {std::string("solver.step=") + step});
          CHECK(run.status == RunStatus::completed);
          CHECK(height(run, run.trajectory.size() - 1) ==
                Approx((turn == 0 ? -1 : 1) * toggle.height(1)).epsilon(0).margin(1e-9));
        }
}

}  // namespace beside_dead_centre_test
