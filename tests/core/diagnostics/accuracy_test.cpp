// SPDX-License-Identifier: BSD-3-Clause
// A run that went wrong says so, and what is known to be wrong is no result.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace accuracy_test {

namespace {

std::vector<std::string> warnings_of(const std::string& method, int stages, double h) {
  SolverOptions options = dvm_options(stages, h, 6.0);
  options.method = method;
  const Simulation run = simulate(make_model(hoop_structure()), options);
  return accuracy_warnings(run, diagnose(run));
}

// 1.3 kg on a spring of 5e4 N/m, drawn out by 0.2 m, in the field `g`; on its own it swings with 196 rad/s.
Scene oscillator(const std::string& method, double step, const std::string& more = "") {
  return read_scene_text(
      "[structure]\nkind = 'custom'\n"
      "[[structure.nodes]]\nname = 'O'\nposition = [0.4, 0.1, -0.3]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'P'\nposition = [1.6, 0.1, -0.3]\nmass = 1.3\n"
      "[[structure.constraints]]\nkind = 'line'\nnodes = ['P']\ndirection = [1, 0, 0]\n"
      "[[forces]]\nkind = 'spring'\nnodes = ['O', 'P']\nstiffness = 5e4\nfree_length = 1.0\n"
      "[solver]\nend_time = 3.0\nmethod = '" +
          method + "'\nstep = " + std::to_string(step) + "\n" + more,
      "oscillator.toml", {});
}

struct Judged {
  Simulation run;
  Diagnostics d;
};

Judged judged(const Scene& scene) {
  Simulation run = simulate(build_model(scene), scene.solver);
  Diagnostics d = judge(run);
  return {std::move(run), std::move(d)};
}

}  // namespace

TEST_CASE("accurate runs have nothing to say against themselves, coarse ones do") {
  CHECK(warnings_of("dvm", 4, 0.01).empty());
  // Second order at h = 0.1: the last rad of the ring's opening takes less than ten steps.
  const auto coarse = warnings_of("dvm", 2, 0.1);
  REQUIRE(coarse.size() == 1);
  CHECK(coarse[0].find("energy balance") != std::string::npos);
  CHECK(coarse[0].find("more solver.stages") != std::string::npos);
  // Runge-Kutta at h = 0.2 s: drift of the rods' lengths goes with h^4, 4e-7 m at h = 0.01.
  const auto drifting = warnings_of("rk4", 2, 0.2);
  REQUIRE_FALSE(drifting.empty());
  CHECK(drifting.back().find("constraints are violated") != std::string::npos);
}

TEST_CASE("a warning never recommends what is chosen, nor what does not help") {
  Simulation run = simulate(make_model(hoop_structure()), dvm_options(3, 0.05, 1.0));
  Diagnostics d = diagnose(run);
  for (Series& column : d.columns)
    if (column.name == "constraint_relative_max") column.values.back() = 0.05;
  const auto by_dvm = accuracy_warnings(run, d);
  REQUIRE(by_dvm.size() == 1);
  CHECK(by_dvm[0].find("by 5 %") != std::string::npos);
  CHECK(by_dvm[0].find("dvm") == std::string::npos);
  run.options.method = "rk4";  // whose order is 4 whatever the stages
  for (Series& column : d.columns)
    if (column.name == "energy_balance_J") column.values.back() = 1e3;
  const auto by_rk4 = accuracy_warnings(run, d);
  REQUIRE(by_rk4.size() == 2);
  CHECK(by_rk4[0].find("stages") == std::string::npos);
  CHECK(by_rk4[1].find("method dvm") != std::string::npos);
}

TEST_CASE("a run that blows up has failed, and what it wrote until then is good") {
  // Explicit Runge-Kutta of order 4 is unstable beyond h omega = 2.83: 3.9 here, a factor 5 in every step.
  for (const char* method : {"rk4", "rk4_projected"}) {
    INFO(method);
    const Judged j = judged(oscillator(method, 0.02));
    CHECK(j.run.status == RunStatus::failed);
    CHECK(j.run.message.find("from t = ") != std::string::npos);
    REQUIRE(j.d.t.size() == j.run.trajectory.size());
    CHECK(j.d.axial_force.rows() == static_cast<Index>(j.d.t.size()));
    CHECK(j.d.t.size() < 10);
    for (const Series& column : j.d.columns) {
      CHECK(column.values.size() == j.d.t.size());
      for (const double x : column.values) CHECK(std::abs(x) < 2e4);  // 1000 J in it
    }
  }
  // Every energy with its NaN: a state far beyond the largest number.
  const Judged far = judged(oscillator("rk4", 0.2));
  CHECK(far.run.status == RunStatus::failed);
  CHECK(std::isfinite(far.d.at("energy_balance_J").values.back()));
  CHECK(accuracy_warnings(far.run, far.d).empty());
}

TEST_CASE("runs within the bounds keep all of their states, whatever their warnings say") {
  // Dissipation of Runge-Kutta: (h omega)^6 / 72 of the energy in each step, 1.8 % over 150 periods at h
  // omega = 0.137 and half as much again where it is 0.147.
  const Judged j = judged(oscillator("rk4", 0.0007));
  CHECK(j.run.status == RunStatus::completed);
  CHECK(j.d.t.size() == j.run.trajectory.size());
  CHECK(j.d.t.back() == Approx(3.0));
  // 8 % and 14 % off, of 1000 J: within and beyond the bound.
  const auto off = [&](double share) {
    Simulation run = j.run;
    run.status = RunStatus::completed;
    Diagnostics d = j.d;
    for (Series& column : d.columns)
      if (column.name == "energy_balance_J")
        for (double& x : column.values) x = share * 1000;
    return accuracy_warnings(run, d);
  };
  REQUIRE(off(0.08).size() == 1);
  CHECK(off(0.08)[0].find("8 %") != std::string::npos);
}

TEST_CASE("energy turned over does not depend on where heights are counted from") {
  const auto turned = [](double height) {
    Structure s = double_pendulum();
    for (Node& node : s.nodes) node.position[2] += height;
    const Simulation run = simulate(make_model(s), dvm_options(4, 0.02, 1.5));
    return energy_turned_over(diagnose(run));
  };
  // 1 km up the potential is 3.4e4 J; its round-off is 1e-11 J.
  CHECK(turned(0) == Approx(turned(1000)).epsilon(1e-9));
}

TEST_CASE("what does not move is not warned of") {
  // A mass at rest on a line across gravity, one hung up by a rod, one on a taut spring, and a load that only
  // pulls at what is fixed: no energy is turned over, and what rounding makes of that is not 100 % of
  // anything.
  const char* hung =
      "[structure]\nkind = 'custom'\n"
      "[[structure.nodes]]\nname = 'O'\nposition = [0.3, 0.7, 1000.1]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'P'\nposition = [0.3, 0.7, 998.8]\nmass = 7.0\n"
      "[[structure.nodes]]\nname = 'Q'\nposition = [0.9, -0.4, 1003.3]\nmass = 0.3\n"
      "[[structure.rods]]\nnodes = ['O', 'P']\nmass = 1.7\n"
      "[[structure.constraints]]\nkind = 'plane'\nnodes = ['Q']\nnormal = [0, 0, 1]\n"
      "[[forces]]\nkind = 'load_over_time'\nnodes = ['P']\nforce = [0, 0, -31.0]\ntimes = [0, 1]\nvalues = "
      "[0, 1]\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 2.0\nstep = 0.013\n";
  for (const char* method : {"dvm", "rk4", "rk4_projected", "generalized_alpha"}) {
    INFO(method);
    const Judged j = judged(read_scene_text(hung, "hung.toml", {std::string("solver.method=") + method}));
    CHECK(j.run.status == RunStatus::completed);
    for (const auto& warning : accuracy_warnings(j.run, j.d)) FAIL(warning);
  }
  // One mass at the origin, held by friction against less and against all that it bears: nothing has a size.
  for (const char* load : {"0.5", "1.9", "2"}) {
    CAPTURE(load);
    const Judged j =
        judged(read_scene_text("[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], "
                               "mass = 1}]\nconstraints = [{kind = "
                               "'line', nodes = ['A'], direction = [1, 0, 0]}]\n[[forces]]\nkind = "
                               "'friction'\nnodes = ['A']\ndirection = [1, "
                               "0, 0]\nkinetic = 2\n[[loads]]\nnodes = ['A']\nforce = [" +
                                   std::string(load) + ", 0, 0]\n[solver]\nend_time = 1\n",
                               "rest.toml"));
    CHECK(j.run.status == RunStatus::completed);
    for (const auto& warning : accuracy_warnings(j.run, j.d)) FAIL(warning);
  }
}

// Two masses and their rod fall freely for 3 s, at a height that doubles tell apart by 3e-14 or by 0.5 m:
// at 3e15 m each state's potential energy, m g z, is rounded by some 8 J of the 1170 J that the fall turns
// over.
TEST_CASE("a balance that rounding alone can put off is said to check nothing, and only there") {
  const auto warnings = [](const std::string& height) {
    const std::string at = ", 0.0, " + height + "]\nmass = 1.3\n";
    const Scene scene =
        read_scene_text("[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'a'\nposition = [3.0" +
                            at + "[[structure.nodes]]\nname = 'b'\nposition = [5.0" + at +
                            "[[structure.rods]]\nnodes = ['a', 'b']\nmass = 0.1\n"
                            "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstep = 0.1\nend_time = 3.0\n",
                        "far.toml", {});
    const Judged fall = judged(scene);
    REQUIRE(fall.run.status == RunStatus::completed);
    return accuracy_warnings(fall.run, fall.d);
  };
  CHECK(warnings("200.0").empty());
  CHECK(warnings("1e9").empty());
  const auto far = warnings("3e15");
  REQUIRE(far.size() == 1);
  CHECK(far[0].find("rounding alone") != std::string::npos);
}

TEST_CASE("steps in which rods turn farther than a method follows are told") {
  // A bar turns freely about its end at 1 rad/s, twenty steps: its energy is kept at any step, its angle is
  // t.
  const auto turned = [](double h, int stages, const std::string& method, const std::string& at) {
    const std::string step = std::to_string(h), end = std::to_string(20 * h);
    const Judged j = judged(read_scene_text(
        "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true},"
        "{name = 'B', position = [1, 0, 0], mass = 1, velocity = [0, 1, 0]}]\n"
        "rods = [{nodes = ['A', 'B'], mass = 1}]\n[solver]\nmethod = '" +
            method + "'\nstages = " + std::to_string(stages) + "\nstep = " + step + "\nend_time = " + end +
            "\n" + at,
        "bar.toml", {}));
    const VectorXd q = j.run.trajectory.node_positions(j.run.trajectory.size() - 1);
    const double t = j.run.trajectory.end_time();
    const double off = std::abs(std::remainder(std::atan2(q[4], q[3]) - t, 2 * std::numbers::pi));
    const bool warned = !accuracy_warnings(j.run, j.d).empty();
    return std::pair(warned, off / (t / (2 * std::numbers::pi)));  // off with every revolution
  };
  const auto check = [&](int stages, const std::string& method, double fine, double coarse,
                         const std::string& at = "") {
    INFO(method << ", " << stages << " stages " << at);
    const auto small = turned(fine, stages, method, at), large = turned(coarse, stages, method, at);
    CHECK(!small.first);
    CHECK(small.second < 0.01);
    CHECK(large.first);
    CHECK(large.second > 0.003);
  };
  check(2, "dvm", 0.08, 0.2);
  check(3, "dvm", 0.7, 1.0);
  check(4, "dvm", 1.5, 2.2);
  check(5, "dvm", 2.0, 3.0);
  check(6, "dvm", 2.9, 3.5);
  check(8, "dvm", 5.4, 7.0);
  for (const int stages : {3, 6, 8}) check(stages, "dvm", 0.09, 0.3, "constraints_at = 'ends'\n");
  check(3, "rk4", 0.3, 0.6);
  check(3, "generalized_alpha", 0.09, 0.15);
}

TEST_CASE("generalized-alpha that damps nothing is told to damp and it helps") {
  // The double pendulum's energy is constant; at rho_inf = 1 it is lost however short the steps.
  const auto balance = [](double rho_inf, double h, std::string& told) {
    SolverOptions options = dvm_options(3, h, 6.0);
    options.method = "generalized_alpha", options.rho_inf = rho_inf;
    const Simulation run = simulate(make_model(double_pendulum()), options);
    const Diagnostics d = diagnose(run);
    told.clear();
    for (const std::string& warning : accuracy_warnings(run, d)) told += warning;
    double most = 0;
    for (const double x : d.at("energy_balance_J").values) most = std::max(most, std::abs(x));
    return most;
  };
  std::string undamped, damped;
  CHECK(balance(1.0, 0.002, undamped) > 100 * balance(0.95, 0.002, damped));
  CHECK(undamped.find("solver.rho_inf <= 0.95") != std::string::npos);
  CHECK(damped.find("rho_inf") == std::string::npos);
}

TEST_CASE("constraints that are lost end a run") {
  // Runge-Kutta on the index-1 equations in steps of 0.1 s, as the pendulum's lower rod whirls: lengths drift
  // off.
  SolverOptions options = dvm_options(3, 0.1, 6.0);
  options.method = "rk4";
  Simulation run = simulate(make_model(double_pendulum()), options);
  run.events.push_back({"late", run.trajectory.end_time()});
  const Diagnostics d = judge(run);
  CHECK(run.status == RunStatus::failed);
  CHECK(run.events.empty());
  for (const double x : d.at("constraint_relative_max").values) CHECK(x <= trusted_share);
}

// Two rods far from the origin, the second of which turns about its first end; the frame is 1.5 m long.
TEST_CASE("what quasi-static rods move is a share of the structure and not of where it stands") {
  Structure s;
  s.nodes = {{"O", {7, -3, 2}, Vec3::Zero(), 1.0},
             {"A", {8.5, -3, 2}, Vec3::Zero(), 1.0},
             {"B", {8.5, -2.2, 2.9}, {0.4, 0.54, -0.48}, 1.0}};
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}}) {
    Rod rod;
    rod.a = a, rod.b = b,
    rod.length =
        (s.nodes[static_cast<std::size_t>(b)].position - s.nodes[static_cast<std::size_t>(a)].position)
            .norm();
    s.rods.push_back(rod);
  }
  const auto model = make_model(s, false);
  Trajectory run(model);
  State state = initial_state(model->structure, model->system).state;
  for (const double t : {0.0, 0.1, 0.2}) {
    state.t = t;
    run.append(state, StepReport{});
    VectorXd u = VectorXd::Zero(9);
    u[5] = -0.03 * (1 + t * (0.3 - t)), u[1] = 0.011;
    run.add_stretch(run.size() - 1, u);
  }
  CHECK(stretch_share(run, 0) == Approx(0.03 / 1.5).epsilon(1e-14));
  const auto [most, at] = largest_of_states(run, stretch_share);
  CHECK(at == 1);
  CHECK(most == Approx(0.03 * 1.02 / 1.5).epsilon(1e-14));
  const StateSize falling = [](const Trajectory& t, std::size_t i) { return 2.5 - t.time(i); };
  CHECK(largest_of_states(run, falling) == std::pair<double, std::size_t>(2.5, 0));
}

}  // namespace accuracy_test
