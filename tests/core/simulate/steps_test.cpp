// SPDX-License-Identifier: BSD-3-Clause
// Where steps end, how long they are, and the polynomials through their ends.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/quintic.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/dense_output.hpp"
#include "core/simulate/simulation.hpp"
#include "core/simulate/step_control.hpp"
#include "core/simulate/time_grid.hpp"
#include "core/study/table.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace steps_test {

namespace {

TimeGrid grid(std::vector<TimeEdge> edges = {}) {
  return TimeGrid(0.3, dvm_options(3, 0.1, 1.07), std::move(edges));
}

// A state of the motion z = p(t), w = p'(t) with the coefficients of p.
State on_polynomial(const std::vector<double>& c, double t) {
  State s;
  s.t = t;
  s.z = s.w = VectorXd::Zero(1);
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto n = static_cast<double>(k);
    s.z[0] += c[k] * std::pow(t, n);
    if (k > 0) s.w[0] += n * c[k] * std::pow(t, n - 1);
  }
  return s;
}

}  // namespace

// Behind ten million steps a time is known to some 1e-9 of a step, and still each step leads on to the next.
TEST_CASE("steps lead on for as many as there are") {
  for (const double step : {1e-4, 4.5e-4, 0.007, 0.01, 0.015, 0.03, 0.1})
    for (const double start : {0.0, 0.3, 1e4}) {
      const TimeGrid regular(start, dvm_options(3, step, start + 1e8 * step), {});
      for (const long first : {1L << 20, 1L << 24, 20479990L, 1L << 26, 99999900L}) {
        long wrong = 0;
        for (long k = first; k < first + 90; ++k) {
          const double now = start + static_cast<double>(k) * step;
          const auto [t, h, edge, jumps, jump] = regular.next(now);
          const double on = std::abs(t - now - step);
          if (!(t > now && on <= 4e-16 * (t + now + start) && std::abs(h - step) <= on)) ++wrong;
        }
        INFO("steps of " << step << " s from " << start << " s, from the " << first << "th on");
        CHECK(wrong == 0);
      }
      CHECK(regular.next(start + 99999999 * step).t == start + 1e8 * step);
    }
}

TEST_CASE("steps end on the grid, and the last one at the end") {
  const TimeGrid regular = grid();
  double now = 0.3;
  for (int k = 1; k <= 7; ++k) {
    const auto step = regular.next(now);
    CHECK(step.t == Approx(0.3 + 0.1 * k).epsilon(1e-15));
    CHECK(step.h == 0.1);  // exactly, so that matrices can be kept
    CHECK_FALSE(step.edge);
    CHECK_FALSE(step.jumps);
    now = step.t;
  }
  CHECK(regular.next(now).t == 1.07);
  CHECK(regular.next(now).h == Approx(0.07).epsilon(1e-13));
  // From between two of its times to the next.
  CHECK(regular.next(0.4321).t == Approx(0.5).epsilon(1e-15));
  CHECK(regular.next(0.4321).h == Approx(0.0679).epsilon(1e-12));
  // A run shorter than a step has one.
  CHECK(TimeGrid(0.3, dvm_options(3, 5, 1.07), {}).next(0.3).t == 1.07);
  // Steps of any size, the last a thousandth longer rather than followed by next to nothing.
  CHECK(regular.next(0.4, 0.173).t == Approx(0.573).epsilon(1e-15));
  CHECK(regular.next(0.4, 0.173).h == 0.173);
  CHECK(regular.next(0.8, 0.2698).t == 1.07);
  CHECK(regular.next(0.8, 0.2695).t == Approx(1.0695).epsilon(1e-15));
  CHECK(regular.next(0.8, 7).t == 1.07);
}

TEST_CASE("steps end at the edges of time, and right before its jumps") {
  const TimeGrid cut = grid({{0.5234, false}, {0.6 + 1e-12, false}, {0.7777, true}, {1.07, false}});
  auto step = cut.next(0.5);
  CHECK(step.t == 0.5234);
  CHECK(step.h == Approx(0.0234).epsilon(1e-12));
  CHECK(step.edge);
  CHECK_FALSE(step.jumps);
  // On to the grid; an edge within rounding of it is the grid's own time.
  step = cut.next(0.5234);
  CHECK(step.t == Approx(0.6).epsilon(1e-15));
  CHECK(step.edge);
  CHECK_FALSE(cut.next(0.4).jumps);
  step = cut.next(0.7);
  CHECK(step.jumps);
  CHECK(step.jump == 0.7777);
  CHECK(step.t < 0.7777);
  CHECK(step.t == Approx(0.7777).epsilon(1e-14));
  // From there the jump itself takes no time.
  step = cut.next(step.t);
  CHECK(step.jumps);
  CHECK(step.h == 0);
  step = cut.next(0.7777);
  CHECK_FALSE(step.jumps);
  CHECK(step.t == Approx(0.8).epsilon(1e-15));
  CHECK_FALSE(cut.next(1.0).edge);  // the end is no edge
  step = cut.next(0.45, 0.2);
  CHECK(step.t == 0.5234);
  CHECK(step.edge);
}

TEST_CASE("the next edge of time is the first behind a time, and none is behind the end") {
  const TimeGrid cut = grid({{0.5234, false}, {0.7777, true}, {0.9, false}, {1.3, false}});
  CHECK(cut.next_edge(0.3) == 0.5234);
  CHECK(cut.next_edge(0.5233) == 0.5234);
  CHECK(cut.next_edge(0.5234) == 0.7777);
  CHECK(cut.next_edge(0.8) == 0.9);
  CHECK(cut.next_edge(0.9) == 1.07);
  CHECK(cut.next_edge(1.06) == 1.07);
  CHECK(grid().next_edge(0.4) == 1.07);
}

TEST_CASE("adaptive steps are those of the turn and change that a step may bring") {
  // A rod of 1.3 m about its end at 2.6 rad/s without forces: omega = 2.6 / s, |w'| / |w| the same, r = 2.6 /
  // (1 + 2.6 h_0 / alpha).
  CustomSpec spec;
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true}, {"A", {1.3, 0, 0}, {0, 2.6 * 1.3, 0}, 0.0, false}};
  spec.rods = {{"OA", {"O", "A"}, 2.0}};
  const auto model = make_model(build_custom(spec));
  SolverOptions options = dvm_options(3, 0.17, 1);
  options.turn = 0.23;
  State state;
  state.z = model->system.reduce((VectorXd(6) << 0, 0, 0, 1.3, 0, 0).finished());
  state.w = VectorXd::Zero(3);
  state.w[1] = 2.6 * 1.3;
  REQUIRE(state.z.size() == 3);
  const double h0 = 0.17, alpha = 0.23, omega = 2.6, r = omega / (1 + omega * h0 / alpha);
  const double wanted = h0 / std::sqrt(1 + std::pow(h0 * (omega + r) / alpha, 2));
  // At a start by where the motion leads to second order, which is off the circle by (omega h)^2 / 2 of it.
  StepControl control(model->structure, model->system, options);
  CHECK(control.next(state) == Approx(wanted).epsilon(0.5 * std::pow(omega * wanted, 2)));
  // Symmetric: h_{n-1/2} h_{n+1/2} is what is wanted, squared, where that is not far from what is wanted.
  control.continue_from(0.7 * wanted);
  CHECK(control.next(state) == Approx(wanted / 0.7).epsilon(1e-12));
  for (const double far : {1e-3, 1e9}) {
    control.continue_from(far * wanted);
    CHECK(control.next(state) == Approx(wanted).epsilon(0.5 * std::pow(omega * wanted, 2)));
  }
  // None is longer than the longest, nor shorter than a hundred thousandth of it.
  state.w[1] = 1e-3;
  StepControl slow(model->structure, model->system, options);
  slow.continue_from(0.8 * slow.next(state));
  CHECK(slow.next(state) == h0);
  state.w[1] = 1e9;
  CHECK(slow.next(state) == Approx(1e-5 * h0).epsilon(1e-12));
}

// Released from rest, swinging up and over, along a chain: a step turns no rod by much more than it may, none
// is longer than the longest, and neighbours differ by what the motion changes.
TEST_CASE("adaptive steps follow the motion from the start on") {
  struct Case {
    const char* scene;
    double step, turn, end;
  };
  for (const Case& c :
       {Case{"pendulum", 0.3, 0.01, 10}, Case{"pendulum", 1, 0.1, 10}, Case{"pendulum", 2, 0.1, 10},
        Case{"pendulum", 10, 1e-3, 0.3}, Case{"pendulum", 0.1, 0.1, 30}, Case{"chain", 0.1, 0.1, 0.6},
        Case{"hoop6_sector", 1, 0.05, 4}}) {
    Scene scene = read_scene_file(find_scene(c.scene));
    scene.solver.adaptive = true;
    scene.solver.stages = 4;
    scene.solver.step = c.step;
    scene.solver.turn = c.turn;
    scene.solver.end_time = c.end;
    const Simulation run = simulate(build_model(scene), scene.solver);
    INFO(c.scene << " " << c.step << " " << c.turn << ": " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    double longest = 0, turned = 0;
    int alternate = 0;
    for (std::size_t i = 1; i < run.trajectory.size(); ++i) {
      const double h = run.trajectory.time(i) - run.trajectory.time(i - 1);
      longest = std::max(longest, h);
      const VectorXd a = run.trajectory.node_positions(i - 1), b = run.trajectory.node_positions(i);
      for (const Rod& rod : run.trajectory.structure().rods) {
        const auto along = [&](const VectorXd& q) -> Vec3 {
          return (q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)) / rod.length;
        };
        turned = std::max(turned, (along(b) - along(a)).norm());
      }
      if (i > 1 && i + 1 < run.trajectory.size()) {
        const double before = run.trajectory.time(i - 1) - run.trajectory.time(i - 2);
        alternate += h > 4 * before || before > 4 * h;
      }
    }
    CHECK(longest <= c.step * (1 + 1e-9));
    // Where the rate grows within a step; twice for what steps alternate by.
    CHECK(turned <= 2 * c.turn);
    CHECK(alternate <= 2);  // from rest
  }
}

// 1 kg on 1e6 N/m, with nothing that turns: x = 1 + cos(1000 t) / 10 in steps of about alpha / omega, of
// order 4 in alpha; its energy, were it 1e-12 of that of what falls beside, is worth no shorter steps, nor is
// a damper's (c = 4 (k m)^1/2) that lets nothing swing.
// What swings by less than a millionth of the structure, be it all that moves, is worth none, either.
// Where something heavy that moves beside hides the swing from them, that is said.
TEST_CASE("adaptive steps follow a swing on a spring") {
  const auto run = [](double amplitude, double damping, double turn, double beside = 1) {
    return run_scene(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1, 0, 0], mass = 1},
         {name = "B", position = [0, 1, 0], mass = 1, velocity = [0, 0, 1]}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [0, 0, 1]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 1e6
free_length = 1
[solver]
adaptive = true
step = 0.01
end_time = 0.1
)",
                     {"structure.nodes[1].position=[" + exact_number(1 + amplitude) + ",0,0]",
                      "forces[0].damping=" + exact_number(damping), "solver.turn=" + exact_number(turn),
                      "structure.nodes[2].mass=" + exact_number(beside)});
  };
  double before = 0;
  for (const double turn : {0.2, 0.1}) {
    const Simulation swings = run(0.1, 0, turn);
    REQUIRE(swings.status == RunStatus::completed);
    CHECK(swings.warnings.empty());
    CHECK(static_cast<double>(swings.steps) == Approx(0.1 * 1000 / turn).epsilon(0.1));
    const double off =
        std::abs(end_positions(swings)[3] - (1 + 0.1 * std::cos(1000 * swings.trajectory.end_time())));
    if (before > 0) CHECK(std::log2(before / off) == Approx(4).margin(0.3));
    before = off;
  }
  CHECK(run(1e-9, 0, 0.1).steps <= 20);
  CHECK(run(1e-4, 0, 0.1, 1e-12).steps > 900);
  for (const double amplitude : {0.0, 1e-16, 1e-7}) CHECK(run(amplitude, 0, 0.1, 1e-12).steps <= 20);
  CHECK(run(0.1, 0, 0.1, 1e12).steps > 900);  // beside 1e8 times its energy
  CHECK(run(0.1, 4000, 0.1).steps <= 100);
}

namespace {

const std::string at_start = R"([structure]
kind = "custom"
[[structure.nodes]]
name = "O"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "P"
position = [1, 0, 0]
mass = 1.3
[solver]
adaptive = true
step = 0.01
end_time = 0.1
)",
                  on_line = "[[constraints]]\nkind = \"line\"\nnodes = [\"P\"]\ndirection = [1, 0, 0]\n",
                  on_spring = "[[forces]]\nkind = \"spring\"\nnodes = [\"O\", \"P\"]\nstiffness = 1e6\n",
                  on_rod = R"([[structure.rods]]
nodes = ["O", "P"]
mass = 0
[[constraints]]
kind = "plane"
nodes = ["P"]
normal = [0, 0, 1]
)",
                  with_hammer = R"([[structure.nodes]]
name = "H"
position = [0.45, 0, 0]
velocity = [8.91, 0, 0]
mass = 0.39
[[constraints]]
kind = "line"
nodes = ["H"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["H", "P"]
direction = [1, 0, 0]
min = 0.05
restitution = 0.8
)",
                  on_cable = R"([[forces]]
kind = "cable"
nodes = ["O", "P"]
axial_stiffness = 1.45e6
length = 1.45
)",
                  with_friction = R"([[forces]]
kind = "friction"
nodes = ["O", "P"]
direction = [1, 0, 0]
kinetic = 5e3
static = 2e4
[[forces]]
kind = "load_over_time"
nodes = ["P"]
force = [4e5, 0, 0]
times = [0, 1]
values = [0, 1]
)";

}  // namespace

// What stands still or flies until an event: a mass on a spring and a rod that a blow sets in motion, a mass
// that a cable throws back, one on a spring that friction lets go. The rest of the step planned before would
// be one of 1 to 10 rad. By closed forms, to order 4 in turn.
TEST_CASE("adaptive steps follow what an event within a step begins") {
  const double omega = std::sqrt(1e6 / 1.3), struck = 0.39 * 1.8 / 1.69 * 8.91;  // behind the blow [m/s]
  // m x'' + k x = 4e5 t - 5e3 from rest at 0.05 s: with s the time from there and x_0 = 0.015, r = 0.4 m/s
  // the place and rate of balance, x' = r + x_0 omega sin - r cos, zero at tan(omega s / 2) = -x_0 omega / r.
  const double x0 = 0.015, r = 0.4, s = 2 / omega * (pi - std::atan(x0 * omega / r));
  struct Case {
    std::string scene;
    std::vector<std::string> changes;
    double x;  // at the end
  };
  for (const Case& c : {Case{at_start + on_line + on_spring + with_hammer,
                             {},
                             1 + struck / omega * std::sin(omega * (0.1 - 0.5 / 8.91))},
                        Case{at_start + on_rod + with_hammer,
                             {"structure.nodes.P.position=[0, 0.1, 0]",
                              "structure.nodes.H.position=[-0.5, 0.1, 0]", "solver.end_time=0.06"},
                             0.1 * std::sin(struck / 0.1 * (0.06 - 0.45 / 8.91))},
                        Case{at_start + on_line + on_cable,
                             {"structure.nodes.P.velocity=[7.77, 0, 0]"},
                             1.45 - 7.77 * (0.1 - 0.45 / 7.77 - pi / omega)},
                        Case{at_start + on_line + on_spring + with_friction,
                             {},
                             1 + x0 + r * s - x0 * std::cos(omega * s) - r / omega * std::sin(omega * s)}}) {
    INFO(c.scene);
    const auto error = [&](double turn) {
      std::vector<std::string> changes = c.changes;
      changes.push_back("solver.turn=" + exact_number(turn));
      const Simulation run = run_scene(c.scene, changes);
      REQUIRE(run.status == RunStatus::completed);
      CHECK(run.warnings.empty());
      return std::abs(end_positions(run)[3] - c.x);
    };
    const double coarse = error(0.05), fine = error(0.025);
    CHECK(coarse < 1e-5 * std::abs(c.x - 1));  // turn^4 = 6e-6
    CHECK(std::log2(coarse / fine) == Approx(4).margin(0.4));
  }
}

// A mass of 1 kg on 2500 N/m swings at 50 rad/s, whatever holds beside it: a block that friction brings to
// rest after 0.25 s, a coordinate that is held. x = sin(50 t) / 50, to order 4 in turn.
TEST_CASE("a stop is found within a step that is too long for a spring that rests") {
  // A ball of 1 kg at 2 m/s meets a block of 2 kg on a spring after 0.6 m. No step longer than 6.7 / w of the
  // spring gets through: its stage equations are singular there.
  const char* const scene = R"(
[structure]
kind = "custom"
nodes = [{name = "W", position = [3, 0, 0], fixed = true}, {name = "S", position = [0, 0, 0], mass = 2},
         {name = "P", position = [-0.7, 0, 0], mass = 1, velocity = [2, 0, 0]}]
[[constraints]]
kind = "line"
nodes = ["S", "P"]
direction = [1, 0, 0]
[[constraints]]
kind = "coordinate_stop"
nodes = ["P", "S"]
direction = [1, 0, 0]
min = 0.1
restitution = 1
[[forces]]
kind = "spring"
nodes = ["S", "W"]
stiffness = 2e4
[solver]
end_time = 1
stages = 4
)";
  for (const char* step : {"solver.step=0.5", "solver.step=0.31"}) {
    INFO(step);
    const Simulation run = run_scene(scene, {step, "solver.adaptive=true"});
    REQUIRE_FALSE(run.events.empty());
    // Located to 1e-9 of a step; the ball flies freely before and behind, at -2/3 m/s.
    CHECK(run.events.front().t == Approx(0.3).epsilon(1e-9));
    CHECK(end_positions(run)[6] == Approx(-0.1 - 0.7 * 2 / 3).epsilon(1e-9));
    // The block leaves at 4/3 m/s, with w = 100/s; adaptive steps follow that to 1e-5 of its amplitude.
    CHECK(end_positions(run)[3] == Approx(4.0 / 300 * std::sin(70)).epsilon(0).margin(1.4e-7));
  }
}

TEST_CASE("adaptive steps follow a swing beside what holds") {
  for (const std::string beside : {"[[structure.nodes]]\nname = 'A'\nposition = [0, 5, 0]\nvelocity = [1, 0, "
                                   "0]\nmass = 1\n[[constraints]]\nkind = 'line'\n"
                                   "nodes = ['A']\ndirection = [1, 0, 0]\n[[forces]]\nkind = "
                                   "'friction'\nnodes = ['A']\ndirection = [1, 0, 0]\nkinetic = 4\n",
                                   "[[structure.nodes]]\nname = 'A'\nposition = [0, 5, 0]\nmass = "
                                   "1\n[[constraints]]\nkind = 'coordinate'\nnodes = ['A']\n"
                                   "direction = [1, 0, 0]\nmotion = 'hold'\n"}) {
    INFO(beside);
    const Simulation run = run_scene(
        "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = "
        "true\n[[structure.nodes]]\n"
        "name = 'B'\nposition = [1, 0, 0]\nvelocity = [1, 0, 0]\nmass = 1\n[[constraints]]\nkind = "
        "'line'\nnodes = ['B']\ndirection = "
        "[1, 0, 0]\n[[forces]]\nkind = 'spring'\nnodes = ['O', 'B']\nstiffness = 2500\n" +
            beside,
        {"solver.adaptive=true", "solver.step=0.2", "solver.end_time=1"});
    REQUIRE(run.status == RunStatus::completed);
    CHECK(end_positions(run)[3] - 1 == Approx(std::sin(50.0) / 50).margin(2e-5));
  }
}

// A load that jumps or a blow sets a mass on a spring swinging, at rest before, in steps that follow it; a
// load that begins to grow does so within a step of 10 rad. At rest nothing is followed.
TEST_CASE("a swing on springs is told where adaptive steps do not follow what begins it") {
  const auto told = [](const std::string& times, const std::string& values) {
    const Simulation run = run_scene(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "P", position = [1, 0, 0], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["P"]
direction = [1, 0, 0]
[[forces]]
kind = "spring"
nodes = ["O", "P"]
stiffness = 1e6
[[forces]]
kind = "load_over_time"
nodes = ["P"]
force = [1, 0, 0]
times = )" + times + "\nvalues = " + values +
                                     "\n[solver]\nadaptive = true\nstep = 0.01\nend_time = 0.1\n");
    REQUIRE(run.status == RunStatus::completed);
    return !run.warnings.empty() && run.warnings[0].find("fastest swing on springs") != std::string::npos;
  };
  CHECK_FALSE(told("[0, 0.05, 0.05, 1]", "[0, 0, 1e4, 1e4]"));
  CHECK_FALSE(told("[0, 0.05, 0.0505, 1]", "[0, 0, 1e4, 1e4]"));
  CHECK(told("[0, 0.05, 1.05]", "[0, 0, 4e5]"));
  CHECK(told("[0, 1]", "[0, 0]"));
}

TEST_CASE("the cubic and the quintic through two states reproduce polynomials") {
  const std::vector<double> three = {0.3, -1.7, 0.9, 2.1}, five = {0.3, -1.7, 0.9, 2.1, -3.3, 1.9};
  const double begin = 0.37, end = 1.11;
  State a = on_polynomial(three, begin), b = on_polynomial(three, end);
  a.angles = VectorXd::Constant(1, 5.0);
  b.angles = VectorXd::Constant(1, 9.0);
  for (const double u : {0.13, 0.5, 0.81}) {
    const double t = begin + u * (end - begin);
    const State s = on_cubic(a, b, t), exact = on_polynomial(three, t);
    CHECK(s.t == t);
    CHECK(s.z[0] == Approx(exact.z[0]).epsilon(1e-13));
    CHECK(s.w[0] == Approx(exact.w[0]).epsilon(1e-12));
    CHECK(s.angles[0] == Approx(5 + 4 * u).epsilon(1e-13));
  }
  const auto bend = [&](double t) {
    double x = 0;
    for (std::size_t k = 2; k < five.size(); ++k) {
      const auto n = static_cast<double>(k);
      x += n * (n - 1) * five[k] * std::pow(t, n - 2);
    }
    return VectorXd(VectorXd::Constant(1, x));
  };
  const State c = on_polynomial(five, begin), d = on_polynomial(five, end);
  const VectorXd bend_c = bend(begin), bend_d = bend(end);
  const Quintic motion{c, d, bend_c, bend_d, end - begin};
  for (const double u : {0.0, 0.13, 0.5, 0.81, 1.0}) {
    const State exact = on_polynomial(five, begin + u * (end - begin));
    CHECK(motion.value(u)[0] == Approx(exact.z[0]).epsilon(1e-12));
    CHECK(motion.rate(u)[0] == Approx(exact.w[0]).epsilon(1e-12));
  }
}

}  // namespace steps_test
