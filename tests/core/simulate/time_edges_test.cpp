// SPDX-License-Identifier: BSD-3-Clause
// Time has edges: no step of any method straddles a bend or a jump of what a scene prescribes over time.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/path/path_run.hpp"
#include "core/structure/time_edges.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace time_edges_test {

namespace {

using testing::end_positions, testing::number, testing::run_scene;

// A free mass of 1.5 kg at 0.3 m/s along x; what pushes it is added.
const std::string mass = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0.2, 0, 0], velocity = [0.3, 0, 0], mass = 1.5}]
[solver]
stages = 4
step = 0.01
end_time = 2
)";

std::vector<std::string> with_method(std::string_view method, bool adaptive) {
  return {"solver.method=" + std::string(method),
          std::string("solver.adaptive=") + (adaptive ? "true" : "false")};
}

}  // namespace

TEST_CASE("a blow much shorter than a step does its work with every method") {
  // 2000 N over 1 ms with ramps of 0.1 ms: 2.2 N s about t = 0.5037 s, far from every multiple of a step.
  const std::string blow = mass + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [2000, 0, 0]
times = [0.5031, 0.5032, 0.5042, 0.5043]
values = [0, 1, 1, 0]
)";
  for (const Method& method : methods())
    for (const bool adaptive : {false, true}) {
      const Simulation run = run_scene(blow, with_method(method.name, adaptive));
      INFO(method.name << (adaptive ? " adaptive" : "") << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      // The trapezium is symmetric about its middle: as if all of it came there. generalized_alpha averages
      // the force over a step; its ramps of 0.1 ms cost it h^2 of them.
      const double impulse = 2000 * 0.0011, x = 0.2 + 0.3 * 2 + impulse / 1.5 * (2 - 0.5037);
      CHECK(end_positions(run)[0] == Approx(x).epsilon(method.name == "generalized_alpha" ? 2e-4 : 1e-11));
    }
}

TEST_CASE("a load that jumps does so between two steps, with every method and on the path") {
  // 30 N from 0.1 to 0.2037 s on 1.5 kg: as a time that stands twice, and as points that no step tells apart.
  const double x = 0.2 + 0.3 * 0.7 + 30 * 0.1037 / 1.5 * (0.7 - 0.15185);
  for (const char* times : {"[0.1, 0.1, 0.2037, 0.2037]", "[0.1, 0.1000000000001, 0.2037, 0.20370000000001]",
                            "[0.0999999999999, 0.1, 0.2036999999, 0.2037000001]"}) {
    const std::string load = mass + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [30, 0, 0]
values = [0, 1, 1, 0]
times = )" + times;
    for (const char* step : {"0.01", "0.1", "0.03"})
      for (const Method& method : methods())
        for (const bool adaptive : {false, true}) {
          std::vector<std::string> options = with_method(method.name, adaptive);
          options.insert(options.end(), {std::string("solver.step=") + step, "solver.end_time=0.7"});
          const Simulation run = run_scene(load, options);
          INFO(times << " " << step << " " << method.name << (adaptive ? " adaptive" : ""));
          REQUIRE(run.status == RunStatus::completed);
          CHECK(run.warnings.empty());
          // A constant force is exact within each step; midpoints of points stand for the jump to 1e-13 s.
          CHECK(end_positions(run)[0] == Approx(x).epsilon(1e-11));
        }
  }
}

// 0.7 + 0.1 is one rounding below 0.8, 0.1 + 0.2 one above 0.3: 1 kg under 100 N from there on, and beside it
// what jumps or ends a ramp at the same time.
TEST_CASE("what jumps as another thing ends, but for rounding, jumps for every method") {
  const auto scene = [](double at, const std::string& beside) {
    return "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], mass = 1}, {name = "
           "'B', "
           "position = [0, 1, 0], mass = 1}]\n[[structure.constraints]]\nkind = 'line'\nnodes = "
           "['A']\ndirection = "
           "[1, 0, 0]\n[[structure.constraints]]\nkind = 'line'\nnodes = ['B']\ndirection = [1, 0, "
           "0]\n[[forces]]\n"
           "kind = 'load_over_time'\nnodes = ['A']\nforce = [100, 0, 0]\ntimes = [" +
           number(at) + ", " + number(at) + "]\nvalues = [0, 1]\n" + beside +
           "[solver]\nstep = 0.01\nend_time = 1\n";
  };
  const std::string drive = "[[constraints]]\nkind = 'coordinate'\nnodes = ['B']\ndirection = [1, 0, 0]\n";
  const auto load = [](double at) {
    return "[[forces]]\nkind = 'load_over_time'\nnodes = ['B']\nforce = [1, 0, 0]\ntimes = [" + number(at) +
           ", " + number(at) + "]\nvalues = [0, 1]\n";
  };
  for (const auto& [at, beside] :
       {std::pair{0.8, drive + "motion = 'smooth'\nto = 0.5\nstart = 0.7\nduration = 0.1\n"},
        {0.8, drive + "motion = 'rate'\nrate = 0.5\nstart = 0.7\nramp = 0.1\n"},
        {0.3, load(0.1 + 0.2)},
        {0.1 + 0.2, load(0.3)},
        {0.3, drive + "motion = 'smooth'\nto = 0.5\nstart = 0.2\nduration = 0.1\n"},
        {0.7 + 0.1, drive + "motion = 'rate'\nrate = 0.5\nstart = 0.8\n"}})
    for (const char* method : {"dvm", "rk4", "rk4_projected", "rk4_baumgarte", "generalized_alpha"}) {
      INFO(at << " " << method << "\n" << beside);
      const Simulation run = run_scene(scene(at, beside), {std::string("solver.method=") + method});
      REQUIRE(run.status == RunStatus::completed);
      const double after = 1 - at;
      // Exact for a load that is constant; generalized_alpha: to order 2 on a parabola.
      CHECK(run.trajectory.node_velocities(run.trajectory.size() - 1)[0] ==
            Approx(100 * after).epsilon(1e-9));
      CHECK(end_positions(run)[0] == Approx(50 * after * after).epsilon(1e-9));
    }
}

TEST_CASE("what jumps where the run ends has no part in its last step, with any method and on the path") {
  const std::string guide =
      "[[structure.constraints]]\nkind = \"line\"\nnodes = [\"A\"]\ndirection = [1, 0, 0]\n";
  const std::string pulse = mass + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [30, 0, 0]
times = [0.5, 0.5, 2, 2]
values = [0, 1, 1, 0]
)";
  const auto check = [&](const Simulation& run) {
    REQUIRE(run.status == RunStatus::completed);
    CHECK(run.trajectory.end_time() == 2);
    // Polynomials of time that every method follows; 200 steps of round-off, and 1.5e-15 s of the way.
    CHECK(end_positions(run)[0] == Approx(0.2 + 0.3 * 2 + 0.5 * 20 * 1.5 * 1.5).epsilon(1e-11));
    CHECK(run.trajectory.velocities(run.trajectory.size() - 1)[0] == Approx(0.3 + 20 * 1.5).epsilon(1e-11));
  };
  // A point that a drive leads on the line from 2 s on at 0.7 m/s, or by a table to its end at 2 s.
  const std::string led = "[[constraints]]\nkind = \"coordinate\"\nnodes = [\"A\"]\ndirection = [1, 0, 0]\n";
  for (const Method& method : methods())
    for (const bool adaptive : {false, true}) {
      const std::vector<std::string> with = with_method(method.name, adaptive);
      INFO(method.name << (adaptive ? " adaptive" : ""));
      check(run_scene(pulse, with));
      std::vector<std::string> at_rest = with;
      at_rest.push_back("structure.nodes.A.velocity=[0,0,0]");
      const Simulation late =
          run_scene(mass + guide + led + "motion = \"rate\"\nrate = 0.7\nstart = 2\n", at_rest);
      REQUIRE(late.status == RunStatus::completed);
      CHECK(end_positions(late)[0] == Approx(0.2).epsilon(1e-12));
      // Both sides are there, and the impulse is the drive's: 1/2 m v^2.
      const std::size_t last = late.trajectory.size() - 1;
      CHECK(late.trajectory.velocities(last - 1)[0] == Approx(0).epsilon(0).margin(1e-12));
      CHECK(late.trajectory.velocities(last)[0] == Approx(0.7).epsilon(1e-12));
      CHECK(diagnose(late).at("drive_work_J").values.back() == Approx(0.5 * 1.5 * 0.49).epsilon(1e-11));
      const Simulation table = run_scene(
          mass + guide + led + "motion = \"table\"\ntimes = [0, 0.7, 2]\nvalues = [0.2, 0.6, 0.5]\n",
          at_rest);
      REQUIRE(table.status == RunStatus::completed);
      CHECK(end_positions(table)[0] ==
            Approx(0.2 + 0.3).epsilon(method.name == "rk4_baumgarte" ? 1e-6 : 1e-9));
      // Clamped: it ends at rest. What methods that do not project drift from a drive is of their order, some
      // 1e-8; generalized_alpha takes velocities of second order, h^2 times a jerk of some 10 m/s^3.
      CHECK(table.trajectory.velocities(table.trajectory.size() - 1)[0] ==
            Approx(0).epsilon(0).margin(method.name == "generalized_alpha" ? 1e-3 : 1e-7));
    }
  const Scene scene = read_scene_text(pulse + guide, "s.toml", {});
  check(simulate_on_path(build_model(scene), scene.solver));
}

TEST_CASE("what sticks or rests lets go when the load jumps, not a step later") {
  // 5 N on 1 kg that 1 N of friction holds: 4 m/s^2 for 0.1 s, then -1 m/s^2.
  const std::string sticks = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[forces]]
kind = "friction"
nodes = ["A"]
direction = [1, 0, 0]
kinetic = 1
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [5, 0, 0]
times = [0.1, 0.1, 0.2, 0.2]
values = [0, 1, 1, 0]
[solver]
end_time = 0.5
)";
  // 10 m/s^2 down on a stop, 30 N up on 1 kg for 0.1 s: 20 m/s^2, then -10.
  const std::string rests = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 1], mass = 1}]
[gravity]
acceleration = [0, 0, -10]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [0, 0, 1]
[[constraints]]
kind = "coordinate_stop"
nodes = ["A"]
direction = [0, 0, 1]
min = 1
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [0, 0, 30]
times = [0.1, 0.1, 0.2, 0.2]
values = [0, 1, 1, 0]
[solver]
end_time = 0.5
)";
  for (const char* model : {"full", "path"})
    for (const char* step : {"0.01", "0.1"})
      for (const char* method : {"dvm", "rk4", "generalized_alpha"}) {
        const std::vector<std::string> options = {std::string("solver.step=") + step,
                                                  std::string("solver.method=") + method};
        INFO(model << " " << step << " " << method);
        const bool path = std::string(model) == "path";
        if (path && std::string(method) != "dvm") continue;
        const auto run_of = [&](const std::string& text) {
          const Scene scene = read_scene_text(text, "s.toml", options);
          return path ? simulate_on_path(build_model(scene), scene.solver)
                      : simulate(build_model(scene), scene.solver);
        };
        const Simulation slips = run_of(sticks), leaves = run_of(rests);
        // Constant forces are exact within each step; events are located to 1e-12 of one.
        CHECK(end_positions(slips)[0] == Approx(1 + 0.02 + 0.4 * 0.3 - 0.045).epsilon(1e-9));
        CHECK(end_positions(leaves)[2] == Approx(1 + 0.1 + 2 * 0.3 - 0.45).epsilon(1e-9));
        for (const Simulation* run : {&slips, &leaves}) {
          CHECK(run->warnings.empty());
          const auto moves = std::ranges::find_if(run->events, [](const Event& e) { return e.t > 0; });
          REQUIRE(moves != run->events.end());
          CHECK(moves->t == Approx(0.1).epsilon(1e-9));
        }
      }
}

TEST_CASE("a blow of which no step would see anything is refused") {
  CHECK_THROWS_WITH(run_scene(mass + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [1, 0, 0]
times = [0.1, 0.1000000000001, 0.1000000000002]
values = [0, 1e13, 0]
)",
                              {}),
                    Catch::Contains("no step follows so short a blow"));
}

TEST_CASE("the paper's order holds over the bends of a load") {
  // F = 7.3 N (t - 0.31) up to 0.77 s, held after: x = x0 + v0 t + F' (t - a)^3 / 6m - F' (t - b)^3 / 6m.
  const std::string ramp = mass + R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [7.3, 0, 0]
times = [0.3137, 0.7771]
values = [0, 0.4634]
)";
  const auto cube = [](double t) { return t * t * t; };
  const double x = 0.2 + 0.3 * 2 + 7.3 / 9 * (cube(2 - 0.3137) - cube(2 - 0.7771));
  for (const char* method : {"dvm", "rk4", "rk4_projected", "rk4_baumgarte"})
    for (const bool adaptive : {false, true}) {
      auto changes = with_method(method, adaptive);
      changes.push_back("solver.step=0.2");
      // Cubics between the bends: exact for all of these.
      CHECK(end_positions(run_scene(ramp, changes))[0] == Approx(x).epsilon(1e-13));
    }
}

TEST_CASE("a drive that starts at once takes its load along, and the energy is the drive's work") {
  // Two free masses on a line, A driven by 2.5 m/s relative to the ground from 0.4137 s on, B coupled to A by
  // a spring of 40 N/m: B = x_B0 + v (t - sin(omega t) / omega) after the start, A imposed.
  const std::string drive = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], mass = 1.5},
  {name = "B", position = [0.8, 0, 0], mass = 0.7}]
[[constraints]]
kind = "coordinate"
name = "motor"
nodes = ["A"]
direction = [1, 0, 0]
motion = "rate"
rate = 2.5
start = 0.4137
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 40
[solver]
stages = 4
step = 0.01
end_time = 1
)";
  const double omega = std::sqrt(40 / 0.7), t = 1 - 0.4137;
  for (const Method& method : methods())
    for (const bool adaptive : {false, true}) {
      const Simulation run = run_scene(drive, with_method(method.name, adaptive));
      INFO(method.name << (adaptive ? " adaptive" : "") << ": " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const VectorXd q = end_positions(run);
      // Errors at omega h = 0.076: order 2 leaves (omega h)^2 / 12 of a swing of 0.33 m, order 4 its square.
      const double tolerance = method.name == "dvm"                 ? 1e-11
                               : method.name == "generalized_alpha" ? 5e-3
                                                                    : 1e-6;
      CHECK(q[0] ==
            Approx(2.5 * t).epsilon(0).margin(std::max(1e-9, method.name == "rk4_baumgarte" ? 1e-7 : 0.0)));
      CHECK(q[3] == Approx(0.8 + 2.5 * (t - std::sin(omega * t) / omega)).epsilon(0).margin(tolerance));
      const Diagnostics d = diagnose(run);
      // The impulse alone is 1.5 kg (2.5 m/s)^2 / 2 = 4.7 J; smeared over a step it was off by 16 %.
      CHECK(testing::largest(d, "energy_balance_J") <= 20 * std::max(tolerance, 1e-9));
    }
}

TEST_CASE("a motion table holds its last value") {
  const std::string table = mass + R"(
[[constraints]]
kind = "coordinate"
name = "slide"
nodes = ["A"]
direction = [1, 0, 0]
motion = "table"
times = [0, 0.5, 1.1037]
values = [0.2, 0.3, 1.4]
)";
  const Simulation run = run_scene(table, {"structure.nodes.A.velocity=[0,0,0]"});
  REQUIRE(run.status == RunStatus::completed);
  CHECK(end_positions(run)[0] == Approx(1.4).epsilon(1e-13));
  CHECK(std::abs(run.trajectory.node_velocities(run.trajectory.size() - 1)[0]) <= 1e-13);
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-9);
}

TEST_CASE("every kind of time function names its edges") {
  Structure s;
  const auto edges_of = [&](TimeFunction f, double step) {
    s.constraints.assign(1, Constraint{});
    s.constraints[0].target = std::move(f);
    return time_edges(s, step);
  };
  TimeFunction f;
  CHECK(edges_of(f, 0.1).empty());
  f.kind = TimeFunction::Kind::rate, f.rate = 3, f.start = 0.7;
  REQUIRE(edges_of(f, 0.1).size() == 1);
  CHECK(edges_of(f, 0.1)[0].jump);
  f.ramp = 0.2;
  REQUIRE(edges_of(f, 0.1).size() == 2);
  CHECK_FALSE(edges_of(f, 0.1)[0].jump);
  CHECK(edges_of(f, 0.1)[1].t == Approx(0.9));
  f.kind = TimeFunction::Kind::smooth, f.duration = 0.3;
  CHECK(edges_of(f, 0.1)[1].t == Approx(1.0));
  CHECK(edges_of(f, 0.15).size() == 2);
  REQUIRE(edges_of(f, 0.1501).size() == 5);
  CHECK(edges_of(f, 0.1501)[1].t == Approx(0.7 + 0.075));
  CHECK(edges_of(f, 0.1501)[4].t == Approx(1.0));
  // A dense table of a smooth motion does not shatter the grid, nor does one that is rounded; its ends still
  // count. A spike in it does too, and points beside it, where the spline swings, by 0.27 less at each.
  std::vector<double> times, values;
  for (int i = 0; i <= 2000; ++i) times.push_back(1e-3 * i), values.push_back(std::cos(1e-3 * pi * i));
  CHECK(edges_of(make_spline(times, values), 0.01).size() == 2);
  CHECK(edges_of(make_spline(times, values), 0.001).size() == 2001);
  std::vector<double> rounded = values;
  for (double& y : rounded) y = 1e-3 * std::round(1e3 * y);
  CHECK(edges_of(make_spline(times, rounded), 0.01).size() < 40);
  values[700] += 0.1;
  const std::vector<TimeEdge> spike = edges_of(make_spline(times, values), 0.01);
  CHECK(spike.size() > 2 + 5);
  for (const TimeEdge& edge : spike)
    CHECK((edge.t == 0.0 || edge.t == times.back() || std::abs(edge.t - times[700]) < 0.0165));
  // Three points on a line and one off it: the first, the third and the last bend.
  f = {};
  f.kind = TimeFunction::Kind::linear, f.times = {0.1, 0.2, 0.3, 0.4}, f.values = {1, 2, 3, 3};
  CHECK(edges_of(f, 0.1).size() == 2);
}

TEST_CASE("all that moves has edges in order, one of one time, and only what leads motions jumps") {
  const auto from = [](double start) {
    TimeFunction f;
    f.kind = TimeFunction::Kind::rate, f.rate = 2, f.start = start;
    return f;
  };
  Structure s;
  s.constraints.resize(2);
  s.constraints[0].target = from(0.9), s.constraints[1].target = from(0.4);
  s.stops.resize(1);
  s.stops[0].reel = from(0.6);
  s.rods.resize(2);
  s.rods[0].warming = from(0.1);  // does not expand
  s.rods[1].expansion = 0.02, s.rods[1].warming = from(0.5);
  s.forces.resize(2);
  s.forces[0].size = from(0.2), s.forces[0].unstressed = from(0.3);
  s.forces[1].motor.command = from(0.8), s.forces[1].size = from(0.4 * (1 + 1e-16));
  const std::vector<std::pair<double, bool>> wanted = {{0.2, false}, {0.3, false}, {0.4, true}, {0.5, true},
                                                       {0.6, true},  {0.8, true},  {0.9, true}};
  const std::vector<TimeEdge> edges = time_edges(s, 0.01);
  REQUIRE(edges.size() == wanted.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    CHECK(edges[i].t == wanted[i].first);
    CHECK(edges[i].jump == wanted[i].second);
  }
}

TEST_CASE("a very short step before or behind an edge leaves no noise to the next ones") {
  // Five points, each two joined by a rod: one rod more than a rigid body has. The load bends 18 or 23 us
  // from a time of the grid, on either side of it.
  for (const double edge : {0.034982, 0.035023}) {
    std::string body = R"([structure]
kind = "custom"
nodes = [
  {name = "a", position = [0.65, -1.77, 0.19], velocity = [0, 1.1, 1], mass = 1.2},
  {name = "b", position = [-0.35, -0.76, -0.05], velocity = [-0.2, 0.8, -1.2], mass = 0.8},
  {name = "c", position = [0.3, -1.45, 0.76], velocity = [-0.9, -0.1, 1.5], mass = 2.1},
  {name = "d", position = [0.48, -2.59, 0.44], velocity = [0.4, 0.6, -0.8], mass = 1.8},
  {name = "e", position = [0.9, -1.77, -0.13], velocity = [-0.7, -1, -1.2], mass = 0.7}]
)";
    for (const char* rod : {"ab", "ac", "ad", "ae", "bc", "bd", "be", "cd", "ce", "de"})
      body +=
          std::string("[[structure.rods]]\nnodes = [\"") + rod[0] + "\", \"" + rod[1] + "\"]\nmass = 0.9\n";
    body += "[[forces]]\nkind = \"load_over_time\"\nnodes = [\"c\"]\nforce = [0.2, 0.3, -0.9]\ntimes = [0, " +
            std::to_string(edge) + ", 0.1]\nvalues = [-13, 14, 6]\n[solver]\nstep = 0.005\nend_time = 0.1\n";
    const auto end = [&](const char* stages) {
      const Simulation run = run_scene(body, {stages});
      REQUIRE(run.status == RunStatus::completed);
      return VectorXd(run.trajectory.node_velocities(run.trajectory.size() - 1));
    };
    // Both are at round-off: orders 8 and 10 at 0.005 s times 3 rad/s. A constraint's round-off of 1e-15 m in
    // a step of 20 us is 1e-10 m/s before the velocities are projected.
    CHECK((end("solver.stages=5") - end("solver.stages=6")).lpNorm<Eigen::Infinity>() <= 1e-11);
  }
}

// The torque of a rate controller jumps with its command, at 0.2 s: no stage of a step that ends there sees
// it. Halving the step makes the error of methods of order 4 a sixteenth, of order 2 a quarter.
TEST_CASE("a motor's command that jumps costs no method its order") {
  const std::string motor = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "W", position = [0, 0, 1], fixed = true},
         {name = "B", position = [1, 0, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[forces]]
kind = "motor"
name = "m"
nodes = ["W", "A", "B"]
axis = [0, 1, 0]
stall_torque = 50
no_load_speed = 100000
control = "rate"
proportional = 10
motion = "rate"
rate = 60
start = 0.2
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 0.5
)";
  const VectorXd right = end_positions(run_scene(motor, {"solver.stages=6", "solver.step=0.0025"}));
  for (const auto& [method, order] : {std::pair{"rk4", 4}, {"rk4_projected", 4}, {"generalized_alpha", 2}}) {
    const auto error = [&, by = std::string(method)](const char* step) {
      const std::vector<std::string> with = {"solver.method=" + by, std::string("solver.step=") + step};
      return (end_positions(run_scene(motor, with)) - right).norm();
    };
    INFO(method);
    CHECK(std::log2(error("0.005") / error("0.0025")) > order - 0.4);
  }
}

}  // namespace time_edges_test
