// SPDX-License-Identifier: BSD-3-Clause
// Runs on the path of what stays where it is.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/path/path_run.hpp"
#include "core/scene/library.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using unfurl::testing::number;

namespace path_at_rest_test {

namespace {

Simulation run_on_path(const std::string& text, const std::vector<std::string>& changes = {}) {
  const Scene scene = read_scene_text(text, "s.toml", changes);
  return simulate_on_path(build_model(scene), scene.solver);
}

// A slider-crank whose slider stands at the limit of its stop and is pressed on it.
const std::string slider_crank = R"toml(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true},
  {name = "C", position = ["=0.5*cos(45*deg)", 0, "=0.5*sin(45*deg)"], mass = 0.3},
  {name = "B", position = ["=0.5*cos(45*deg)+sqrt(1.2^2-(0.5*sin(45*deg))^2)", 0, 0], mass = 1}]
rods = [{nodes = ["A", "C"], mass = 1}, {nodes = ["C", "B"], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[[constraints]]
kind = "plane"
nodes = ["C"]
normal = [0, 1, 0]
[[constraints]]
kind = "coordinate_stop"
name = "end"
nodes = ["B"]
direction = [1, 0, 0]
max = "=0.5*cos(45*deg)+sqrt(1.2^2-(0.5*sin(45*deg))^2)"
restitution = 0
[gravity]
acceleration = [3, 0, -5]
[solver]
step = 0.007
end_time = 0.8
)toml";

}  // namespace

// However weakly: gravity along the line alone, of 1e-9 m/s^2, would need 1e-1 s to go through the stop by
// what counts as touching. Peaks are those of what never moves: none but rounding, of coordinates of 1 m over
// a step of 7 ms.
TEST_CASE("what is pressed on a stop at the start rests on it from the start and never moves") {
  for (const double g : {3.0, 1e-3, 1e-9, 1e4})
    for (const double restitution : {0.0, 0.6}) {
      CAPTURE(g, restitution);
      const Simulation run = run_on_path(slider_crank, {"gravity.acceleration=[" + number(g) + ",0,0]",
                                                        "constraints[2].restitution=" + number(restitution)});
      CHECK(run.status == RunStatus::completed);
      REQUIRE(run.events.size() == 1);
      CHECK(run.events[0].name == "rests on stop end");
      CHECK(run.events[0].t == 0);
      CHECK(run.events[0].energy_lost == 0);
      const Diagnostics d = diagnose(run);
      CHECK(largest_of_column(run, d, "kinetic_energy_J") <= 1e-24);
      CHECK(find_measure("peak_speed").value(run, d) <= 1e-12);
      CHECK((testing::end_positions(run) - run.trajectory.node_positions(0)).lpNorm<Eigen::Infinity>() <=
            1e-14);
    }
  // A push that begins with nothing is there right behind the start.
  const Simulation ramp = run_on_path(
      slider_crank,
      {"gravity.acceleration=[0,0,0]",
       R"(forces=[{kind="load_over_time",nodes=["B"],force=[4,0,0],times=[0,0.2],values=[0,1]}])"});
  REQUIRE(ramp.events.size() == 1);
  CHECK(ramp.events[0].t == 0);
  CHECK((testing::end_positions(ramp) - ramp.trajectory.node_positions(0)).lpNorm<Eigen::Infinity>() <=
        1e-14);
  // The other way it leaves at once, and nothing holds it.
  const Simulation away = run_on_path(slider_crank, {"gravity.acceleration=[-3,0,0]", "solver.end_time=0.1"});
  CHECK(away.events.empty());
  CHECK(largest_of_column(away, diagnose(away), "kinetic_energy_J") > 0.01);
}

// Balanced weights: all that is left is rounding, of m g times the coordinates, which is not judged by
// itself.
// By both models alike, wherever the stop is met: rounding leaves 1e-15 of the speed, and no force.
TEST_CASE("what an impact stops, and nothing pulls away, rests on the stop") {
  for (int k = 0; k < 13; ++k) {
    const Scene scene = read_scene_file(
        find_scene("four_bar"), {"constraints[0]={kind=\"length_stop\",name=\"s\",nodes=[\"A\",\"C\"],min=" +
                                     number(2 + 0.1 * k) + ",restitution=0}",
                                 "solver.end_time=1.5"});
    const auto model = build_model(scene);
    for (const Simulation& run : {simulate(model, scene.solver), simulate_on_path(model, scene.solver)}) {
      REQUIRE(run.events.size() == 1);
      CHECK(run.events[0].name == "rests on stop s");
    }
  }
}

// A pendulum comes down on a stop at its lowest point, whatever the direction of gravity; a load pulls it off
// from 0.8 s on. Rounding does not, at 0.5 s.
TEST_CASE("what rests where nothing pulls is left when something does") {
  for (int k = 0; k < 24; ++k) {
    const double a = 0.26 * k, x = -std::cos(a), z = -std::sin(a);
    CAPTURE(a);
    const auto vector = [](double p, double q) { return "[" + number(p) + ", 0, " + number(q) + "]"; };
    const Simulation run = run_on_path(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, {name = "
        "'E', "
        "position = " +
        vector(x, z) + ", fixed = true}, {name = 'P', position = " + vector(z, -x) +
        ", mass = 1}]\nrods = [{nodes = ['O', 'P'], mass = 0}]\n[[constraints]]\nkind = 'plane'\nnodes = "
        "['P']\n"
        "normal = [0, 1, 0]\n[[constraints]]\nkind = 'angle_stop'\nname = 's'\nnodes = ['E', 'O', 'P']\n"
        "axis = [0, 1, 0]\nmin = 0\nmax = 200\nrestitution = 0\n[[forces]]\nkind = 'load_over_time'\nnodes = "
        "['P']\n"
        "force = " +
        vector(z, -x) + "\ntimes = [0.8, 0.9]\nvalues = [0, 1]\n[gravity]\nacceleration = " +
        vector(9.81 * x, 9.81 * z) + "\n[solver]\nend_time = 1\n");
    REQUIRE(run.events.size() == 2);
    CHECK(run.events[0].name == "rests on stop s");
    CHECK(run.events[1].name == "leaves stop s");
    CHECK(run.events[1].t == Approx(0.8).epsilon(0).margin(1e-6));
  }
}

TEST_CASE("a structure on which nothing acts is no failure on the path") {
  const std::vector<std::string> no_stop{"constraints[2].enabled=false", "solver.end_time=0.5"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), no_stop.begin(), no_stop.end());
    const Scene scene = read_scene_text(slider_crank, "s.toml", more);
    Simulation run = simulate_on_path(build_model(scene), scene.solver);
    const Diagnostics d = judge(run);
    CHECK(run.status == RunStatus::completed);
    CHECK(accuracy_warnings(run, d).empty());
    CHECK((testing::end_positions(run) - run.trajectory.node_positions(0)).lpNorm<Eigen::Infinity>() <=
          1e-12);
  };
  const std::string offload = R"(forces=[{kind="offload",nodes=["*"],trolley="following"}])";
  for (const std::string g : {"[0.9,-0.6,-9.81]", "[0,0,-9.81]", "[30,0,-5000]", "[1e-6,0,1e-7]"}) {
    CAPTURE(g);
    with({offload, "gravity.acceleration=" + g});
  }
  // The same of forces that are as large and point against each other.
  with({"gravity.acceleration=[0,0,0]",
        R"(loads=[{nodes=["B"],force=[700,0,0]},{nodes=["B"],force=[-700,0,0]}])"});
  with(
      {"gravity.acceleration=[0,0,0]",
       R"(forces=[{kind="spring",nodes=["A","B"],stiffness=1e7,free_length=1.4,damping=0},)"
       R"({kind="spring",nodes=["A","B"],stiffness=1e7,free_length="=2*(0.5*cos(45*deg)+sqrt(1.2^2-(0.5*sin(45*deg))^2))-1.4"}])"});
}

// A load that jumps at what stands still: nothing holds a force of 100 N there that gives 2 or 80 N at most,
// or a stop that only pushes. In every state what holds A along its line is that force at most, and the peaks
// are those of the full model.
TEST_CASE("what a jump sets free holds in no state of the path what it cannot hold") {
  const std::string arms = R"toml(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0], mass = 1},
  {name = "B", position = [1.6, 0, 0.8], mass = 1}]
rods = [{nodes = ["O", "B"], mass = 0}, {nodes = ["A", "B"], mass = 0}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]},
  {kind = "plane", nodes = ["B"], normal = [0, 1, 0]}]
[solver]
end_time = 0.2
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [100, 0, 0]
times = [0, 0.1, 0.1, 1]
)toml";
  const auto friction = [](double kinetic, double hold) {
    return "[[forces]]\nkind = 'friction'\nnodes = ['A']\ndirection = [1, 0, 0]\nkinetic = " +
           number(kinetic) + "\nstatic = " + number(hold) + "\n";
  };
  struct Case {
    std::string more;
    double least, most;  // of what holds A along x [N]
  };
  for (const Case& one :
       {Case{"values = [0, 0, 1, 1]\n" + friction(1, 2), -2, 2},
        Case{"values = [0.5, 0.5, -1, -1]\n" + friction(60, 80), -80, 80},
        Case{"values = [-0.1, -0.1, 1, 1]\n[[constraints]]\nkind = 'coordinate_stop'\nnodes = ['A']\n"
             "direction = [1, 0, 0]\nmin = 1.0\n",
             0, 10}}) {
    CAPTURE(one.more);
    const Scene scene = read_scene_text(arms + one.more, "s.toml", {});
    const auto model = build_model(scene);
    const Simulation path = simulate_on_path(model, scene.solver), full = simulate(model, scene.solver);
    REQUIRE(path.status == RunStatus::completed);
    CHECK(path.events.size() == full.events.size());
    const Diagnostics d = diagnose(path), e = diagnose(full);
    const double rounding = 1e-9;
    CHECK(smallest_of_column(path, d, "A.reaction_x_N") >= one.least - rounding);
    CHECK(largest_of_column(path, d, "A.reaction_x_N") <= one.most + rounding);
    for (const char* column : {"A.reaction_N", "O.reaction_N", "axial_force_max_N", "axial_force_min_N"})
      CHECK(peak_of_column(path, d, column) == Approx(peak_of_column(full, e, column)).epsilon(1e-7));
    std::size_t at_jump = 0;
    for (std::size_t i = 0; i < path.trajectory.size(); ++i)
      at_jump += std::abs(path.trajectory.time(i) - 0.1) < 1e-9;
    CHECK(at_jump == 2);  // before and behind
  }
}

// A load of 10 N/s from 0 on, gone at 1 s, whichever steps end there: what holds 9.2 N gives way at 0.92 s.
TEST_CASE("a load frees what rests at its peak, also where it jumps away at once") {
  constexpr double t0 = 0.92;
  const auto run_with = [](double step, const std::string& more) {
    return run_on_path(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [-1, 0, 0], fixed = true}, {name = "P", position = [0, 0, 0], mass = 1}]
constraints = [{kind = "line", nodes = ["P"], direction = [1, 0, 0]}]
[[forces]]
kind = "load_over_time"
nodes = ["P"]
force = [1, 0, 0]
times = [0, 1, 1, 2]
values = [0, 10, 0, 0]
)" + more + "[solver]\nstep = " +
                       number(step) + "\nend_time = " + (more.starts_with("[[forces]]") ? "2\n" : "1.05\n"));
  };
  for (const double step : {0.01, 0.1, 0.125, 0.25, 0.3, 3.0}) {
    CAPTURE(step);
    const Simulation slips = run_with(step, R"([[forces]]
kind = "friction"
nodes = ["P"]
direction = [1, 0, 0]
kinetic = 0
static = 9.2
)");
    REQUIRE(slips.events.size() == 1);
    CHECK(slips.events[0].kind == "slip");
    CHECK(slips.events[0].t == Approx(t0).epsilon(1e-12));  // bisected to rounding
    // x'' = 10 t until 1 s, nothing then.
    const double v = 5 * (1 - t0 * t0), x = 5 * ((1 - t0 * t0 * t0) / 3 - t0 * t0 * (1 - t0));
    CHECK(testing::end_positions(slips)[3] == Approx(x + v).epsilon(1e-11));
    // Held by a stop instead: x'' = 10 (t - t0), and -9.2 behind the jump.
    const Simulation leaves = run_with(step, R"([[loads]]
nodes = ["P"]
force = [-9.2, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["P"]
direction = [1, 0, 0]
min = 0
restitution = 0
)");
    REQUIRE(leaves.events.size() == 3);
    CHECK(leaves.events[1].kind == "free");
    CHECK(leaves.events[1].t == Approx(t0).epsilon(1e-12));
    const double d = 1 - t0, u = 5 * d * d, y = 5 * d * d * d / 3;
    const double back = 1 + (u + std::sqrt(u * u + 2 * 9.2 * y)) / 9.2;
    CHECK(leaves.events[2].kind == "contact");
    CHECK(leaves.events[2].t == Approx(back).epsilon(1e-11));
  }
}

// 1.7 kg at 0.9 m/s: held back by both, at rest by both until the load is 0.55 N, and again by both.
TEST_CASE("two frictions of one coordinate act as one with their sum") {
  const std::string begin = R"([structure]
kind = "custom"
nodes = [{name = "P", position = [0.3, 0, 0], mass = 1.7, velocity = [0.9, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "load_over_time"
nodes = ["P"]
force = [1, 0, 0]
times = [5, 9]
values = [0, 2]
[solver]
step = 0.01
end_time = 7
)";
  const auto friction = [](const std::string& name, double kinetic, double most) {
    return "[[forces]]\nkind = 'friction'\nname = '" + name +
           "'\nnodes = ['P']\ndirection = [1, 0, 0]\nkinetic = " + number(kinetic) +
           "\nstatic = " + number(most) + "\n";
  };
  for (const std::string& text :
       {friction("both", 0.34, 0.55), friction("one", 0.13, 0.25) + friction("other", 0.21, 0.3)}) {
    const Simulation run = run_on_path(begin + text);
    REQUIRE(run.status == RunStatus::completed);
    const double stops = 1.7 * 0.9 / 0.34, gives = 6.1, late = 7 - gives;
    for (const Event& event : run.events)
      CHECK((event.t < 5.5 ? stops : gives) == Approx(event.t).epsilon(1e-11));
    CHECK(run.trajectory.positions_at(5.5)[0] == Approx(0.3 + 0.45 * stops).epsilon(1e-11));
    // (0.55 - 0.34) t + 0.5 t^2 / 2 of impulse from there on.
    CHECK(testing::end_positions(run)[0] ==
          Approx(0.3 + 0.45 * stops + (0.21 * late * late / 2 + 0.5 * std::pow(late, 3) / 6) / 1.7)
              .epsilon(1e-11));
  }
}

}  // namespace path_at_rest_test
