// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/diagnostics/accuracy.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/study/measured_run.hpp"
#include "core/study/reference.hpp"
#include "core/study/table.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("the true error is below the tolerance that was asked for") {
  const auto ring = make_model(hoop_structure({{"model", std::string("sector")}}));
  const auto pendulum = make_model(double_pendulum());
  const Reference truth = solve_reference(pendulum, 2.0, 20, {});
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    INFO(tolerance);
    SolverOptions options = dvm_options(3, 0.01, 2.0);
    options.tolerance = tolerance;
    const Simulation swing = simulate_as_asked(pendulum, options);
    CHECK(swing.position_estimate <= tolerance);
    const auto last = swing.trajectory.size() - 1;
    CHECK(node_distance(swing.trajectory.node_positions(last), truth.q.back()) <= tolerance);

    options.end_time = 4.5;
    const Simulation unfolding = simulate_as_asked(ring, options);
    const auto end = unfolding.trajectory.size() - 1;
    const double angle = ring->structure.deployment.fold_angle(unfolding.trajectory.node_positions(end));
    // The hinge moves by up to 2 k l1 = 12 m per rad of the fold angle, none moves faster.
    CHECK(std::abs(angle - exact_hoop().angle(4.5)) <= tolerance);
  }
}

TEST_CASE("what was solved along its path says its error where a tolerance was asked for") {
  const auto ring = make_model(hoop_structure());
  SolverOptions options = dvm_options(3, 0.02, 2.0);
  options.model = "path";
  CHECK(std::isnan(simulate_as_asked(ring, options).position_estimate));
  options.tolerance = 1e-6;
  const Simulation run = simulate_as_asked(ring, options);
  CHECK(run.solved_as.name == "path");
  CHECK(run.position_estimate > 0);
  CHECK(run.position_estimate <= 1e-10);
  options.tolerance = 1e-15;
  const Simulation tight = simulate_as_asked(ring, options);
  REQUIRE_FALSE(tight.warnings.empty());
  CHECK(tight.warnings.back() == "the tolerance of 1e-15 m is out of reach; the estimated error is " +
                                     short_number(tight.position_estimate) + " m");
}

// Of a sector it is no reason that it has none.
TEST_CASE("why it is the full model that was solved is told of each of the others that it could have been") {
  SolverOptions options = dvm_options(3, 0.02, 0.05);
  options.model = "auto";
  const auto why = [&](const Structure& structure) {
    const Simulation run = simulate_as_asked(make_model(structure), options);
    CHECK(run.solved_as.name != "path");
    return run.solved_as.why;
  };
  const std::string pendulum = why(double_pendulum());
  CHECK(pendulum.starts_with("no path: "));
  CHECK(pendulum.find("; no sector: no turn by a third") != std::string::npos);
  Structure sector = hoop_structure({{"model", std::string("sector")}, {"fold_angle", 63.0}});
  Force spin;  // which the path does not know
  spin.kind = "motor", spin.name = "crank", spin.measure.kind = MeasureKind::fold;
  spin.motor.stall = 3, spin.motor.no_load_speed = 7, spin.motor.limit = 2;
  sector.forces.push_back(spin);
  CHECK(why(sector) == "no path: the current of a motor is limited");
}

TEST_CASE("a tolerance below round-off is said to be out of reach") {
  SolverOptions options = dvm_options(3, 0.01, 1.0);
  options.tolerance = 1e-18;
  const Simulation run = simulate_as_asked(make_model(double_pendulum()), options);
  CHECK(run.status == RunStatus::completed);
  REQUIRE_FALSE(run.warnings.empty());
  CHECK(run.warnings.back().find("out of reach") != std::string::npos);
}

TEST_CASE("a run that is picked for a tolerance is one that its own books trust") {
  // A cart is pulled 1 mm aside and back within 2 ms. In long steps, which hardly see it, all nodes are
  // within 1e-5 m of where they should be, and the drive's work is off by most of the energy.
  const std::string jerk = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 1},
         {name = "B", position = [0.29552020666133955, 0, -0.955336489125606], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 1, 0]
[[constraints]]
kind = "coordinate"
nodes = ["A"]
direction = [1, 0, 0]
motion = "table"
times = [0, 0.5, 0.501, 0.502, 1.1]
values = [0, 0, 0.001, 0, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
end_time = 1
)";
  const Scene scene = read_scene_text(jerk, "jerk.toml");
  const auto model = build_model(scene);
  SolverOptions resolved = scene.solver;
  resolved.stages = 6, resolved.step = 2.5e-4;  // four steps between two points of the table
  const Simulation truth = simulate(model, resolved);
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7}) {
    INFO(tolerance);
    SolverOptions options = scene.solver;
    options.tolerance = tolerance;
    Simulation run = simulate_as_asked(model, options);
    CHECK(run.position_estimate <= tolerance);
    judge(run);
    CHECK(run.status == RunStatus::completed);
    const auto last = run.trajectory.size() - 1, end = truth.trajectory.size() - 1;
    CHECK(run.trajectory.end_time() == Approx(1).epsilon(1e-12));
    CHECK(node_distance(run.trajectory.node_positions(last), truth.trajectory.node_positions(end)) <=
          tolerance);
  }
}

TEST_CASE("tighter tolerances cost more work, by stages or steps") {
  SolverOptions options = dvm_options(3, 0.01, 2.0);
  const auto model = make_model(double_pendulum());
  options.tolerance = 1e-3;
  const Simulation loose = simulate_as_asked(model, options);
  options.tolerance = 1e-9;
  const Simulation tight = simulate_as_asked(model, options);
  CHECK(loose.newton_iterations < tight.newton_iterations * 2);
  CHECK(tight.position_estimate < loose.position_estimate);
}

// The solves of a run, a factorisation as much as eight: what it costs. Of runs with steps of its own grids,
// of any stages, whose true error is below the tenth of what is let pass, none is much cheaper.
TEST_CASE("a pick for a tolerance costs little more than the cheapest run that meets it well") {
  const auto cost = [](const Simulation& run) {
    double solves = 8.0 * static_cast<double>(run.factorisations);
    for (std::size_t i = 0; i < run.trajectory.size(); ++i)
      solves += run.trajectory.report(i).right_hand_sides;
    return solves;
  };
  const auto model = make_model(double_pendulum());
  constexpr int parts = 35;
  const Reference truth = solve_reference(model, 2.0, parts, {});
  const auto error = [&](const Simulation& run) {
    double most = 0;
    for (std::size_t i = 0; i < truth.t.size(); ++i) {
      VectorXd q(model->system.coordinates());
      model->system.expand(run.trajectory.state_at(truth.t[i]).z, q);
      most = std::max(most, node_distance(q, truth.q[i]));
    }
    return most;
  };
  std::vector<std::pair<double, double>> all;  // error, cost
  for (int stages = 2; stages <= 7; ++stages)
    for (const int more : {1, 2, 4, 8, 16}) {
      const Simulation run = simulate(model, dvm_options(stages, 2.0 / (parts * more), 2.0));
      all.emplace_back(error(run), cost(run));
    }
  for (const double tolerance : {3e-2, 1e-4, 1e-8, 1e-11}) {
    SolverOptions options = dvm_options(3, 0.01, 2.0);
    options.tolerance = tolerance;
    const Simulation run = simulate_as_asked(model, options);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [off, solves] : all)
      if (off <= 0.1 * tolerance) least = std::min(least, solves);
    INFO(tolerance << ": " << run.options.stages << " stages, " << run.steps << " steps, " << cost(run)
                   << " of " << least);
    CHECK(error(run) <= tolerance);
    CHECK(cost(run) <= 1.25 * least);
  }
}

namespace tolerance_test {

namespace {

struct Case {
  std::string scene;
  double end, exact;  // x or z of P at the end, the coordinate `axis`
  Index axis;
};

std::string text_of(double x) {
  return exact_number(x);
}

std::string mass_point(const std::string& position, double mass) {
  return "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'O'\nposition = [0, 0, 0]\nfixed = true\n"
         "[[structure.nodes]]\nname = 'P'\nposition = " +
         position + "\nmass = " + text_of(mass) + "\n";
}

// A blow on a free mass: up, on and down along straight lines; a momentum J about the middle t_m of the
// trapezium.
Case blow(std::mt19937& random) {
  const auto any = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double mass = any(0.5, 5), force = any(100, 3000), start = any(0.1, 0.6), up = any(1e-5, 1e-3),
               on = any(1e-4, 5e-3), end = any(0.8, 1.5);
  const double middle = start + up + on / 2, momentum = force * (up + on);
  return {mass_point("[1, 0.3, 0]", mass) + "[[forces]]\nkind = 'load_over_time'\nnodes = ['P']\nforce = [" +
              text_of(force) + ", 0, 0]\ntimes = [" + text_of(start) + ", " + text_of(start + up) + ", " +
              text_of(start + up + on) + ", " + text_of(start + up + on + up) + "]\nvalues = [0, 1, 1, 0]\n",
          end, 1 + momentum / mass * (end - middle), 3};
}

// A mass that rests on a stop until a load that grows like r t lifts it at t_0 = m g / r: z = r (t - t_0)^3 /
// 6 m.
Case lifted(std::mt19937& random) {
  const auto any = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double mass = any(0.5, 5), start = any(0.2, 0.7), rate = mass * 9.81 / start,
               end = start + any(0.2, 0.6);
  return {mass_point("[1, 0, 0.4]", mass) +
              "[[forces]]\nkind = 'load_over_time'\nnodes = ['P']\nforce = [0, 0, " + text_of(rate) +
              "]\ntimes = [0, 3]\nvalues = [0, 3]\n[[constraints]]\nkind = 'coordinate_stop'\nname = "
              "'floor'\nnodes = "
              "['P']\ndirection = [0, 0, 1]\nmin = 0.4\n[gravity]\nacceleration = [0, 0, -9.81]\n",
          end, 0.4 + rate * std::pow(end - start, 3) / (6 * mass), 5};
}

// A mass on a cable, drawn out by a: a quarter of a swing, then free flight with a omega.
Case cable(std::mt19937& random) {
  const auto any = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double mass = any(0.5, 5), omega = any(3, 12), drawn = any(0.1, 0.4),
               slack = 0.5 * std::acos(-1.0) / omega, end = slack + any(0.3, 1.5) / (drawn * omega);
  return {mass_point("[" + text_of(1 + drawn) + ", 0, 0]", mass) +
              "[[structure.constraints]]\nkind = 'line'\nnodes = ['P']\ndirection = [1, 0, "
              "0]\n[[forces]]\nkind = "
              "'spring'\nnodes = ['O', 'P']\nstiffness = " +
              text_of(mass * omega * omega) + "\nfree_length = 1\ntension_only = true\n",
          end, 1 - drawn * omega * (end - slack), 3};
}

}  // namespace

TEST_CASE("what a tolerance claims of blows, stops that let go and cables that slacken is true") {
  std::mt19937 random(20261);
  int kept = 0;
  for (int i = 0; i < 12; ++i) {
    const Case c = i % 3 == 0 ? blow(random) : i % 3 == 1 ? lifted(random) : cable(random);
    for (const double tolerance : {1e-4, 1e-7}) {
      const Scene scene = read_scene_text(
          c.scene + "[solver]\ntolerance = " + text_of(tolerance) + "\nend_time = " + text_of(c.end) + "\n",
          "random.toml", {});
      const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
      REQUIRE(run.status == RunStatus::completed);
      const double error = std::abs(run.trajectory.positions(run.trajectory.size() - 1)[c.axis] - c.exact);
      INFO(c.scene << "tolerance " << tolerance << ", error " << error << ", estimate "
                   << run.position_estimate);
      const bool said =
          !run.warnings.empty() && run.warnings.back().find("out of reach") != std::string::npos;
      CHECK((said || error <= tolerance));
      CHECK((said || run.position_estimate <= tolerance));
      kept += said ? 0 : 1;
    }
  }
  CHECK(kept > 20);
}

// What deploys early in its time has few steps before, and none that grids of other steps share; an error may
// die between times that they do. The truth is seven stages with steps of 1/40, whose error is below 1e-10 of
// the first one's.
TEST_CASE(
    "the error at every state of a run is what its tolerance claims, deployed after one step or thirty") {
  const std::string dragged = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1, 0, 0.2], velocity = [0, 0.4, 0], mass = 0.5}, {name = "B", position = [1.6, 0, -0.3], mass = 0.5}]
rods = [{nodes = ["O", "A"], mass = 1}, {nodes = ["A", "B"], mass = 0.4}]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "load_over_time"
nodes = ["B"]
force = [0, 400, 0]
times = [0.3, 0.301, 0.302]
values = [0, 1, 0]
[[forces]]
kind = "drag"
nodes = ["A", "B"]
damping = 200
[solver]
end_time = 2
)";
  const auto library = [](const char* name, double end_time) {
    return read_scene_file(find_scene(name), {"solver.end_time=" + text_of(end_time)});
  };
  const std::vector<std::pair<Scene, std::vector<double>>> cases = {
      {library("scissor_mast", 60), {1e-4, 1e-6}},
      {library("scissor_mast", 8), {1e-6}},
      {library("bricard", 6), {1e-5, 1e-9}},
      {library("scissor_ring", 60), {1e-6}},
      {read_scene_text(dragged, "s.toml", {}), {1e-5, 1e-9}}};
  for (const auto& [scene, tolerances] : cases)
    for (const double tolerance : tolerances) {
      SolverOptions options = scene.solver;
      options.model = "full";
      options.tolerance = tolerance;
      const auto model = build_model(scene);
      const Simulation run = simulate_as_asked(model, options);
      INFO(scene.title << " within " << tolerance << ", " << run.steps << " steps of " << run.options.stages
                       << " stages");
      REQUIRE(run.position_estimate <= tolerance);
      options.tolerance = 0;
      options.stages = 7;
      options.step = std::min(run.options.step, run.trajectory.end_time()) / 40;
      options.adaptive = false;
      const Simulation truth = simulate(model, options);
      double error = 0;
      for (std::size_t i = 0; i < run.trajectory.size(); ++i)
        if (run.trajectory.time(i) <= truth.trajectory.end_time())
          error = std::max(error, node_distance(run.trajectory.positions(i),
                                                truth.trajectory.positions_at(run.trajectory.time(i))));
      CHECK(error <= tolerance);
      CHECK(error <= 10 * run.position_estimate + 1e-12);
      if (run.status == RunStatus::deployed)
        CHECK(std::abs(run.trajectory.end_time() - truth.trajectory.end_time()) <= 10 * tolerance);
    }
}

TEST_CASE("a tolerance ends in bounded time where it cannot be met") {
  // The ring of joints next to its dead centre: round-off decides when it begins to move.
  const auto model = make_model(hoop_structure({{"model", std::string("joints")},
                                                {"units", 4L},
                                                {"chord_rod_length", 1.7},
                                                {"fold_angle", 89.86},
                                                {"hinge_force", 20.0}}));
  SolverOptions options = dvm_options(3, 0.01, 38.0);
  options.tolerance = 1e-8;
  long steps = 0;
  SimulationHooks counting;
  counting.cancelled = [&] { return ++steps < 0; };
  const Simulation run = simulate_as_asked(model, options, counting);
  CHECK(run.status == RunStatus::deployed);
  CHECK(std::isfinite(run.position_estimate));
  // Of all runs together: 3130, some 5 s. A sanitizer's build takes as many.
  CHECK(steps < 10000);
}

TEST_CASE("a pick that is cancelled has stopped, whichever of its runs it was") {
  const auto model = make_model(double_pendulum());
  SolverOptions options = dvm_options(3, 0.01, 0.5);
  options.tolerance = 1e-6;
  long asked = 0;
  SimulationHooks counting;
  counting.cancelled = [&] { return ++asked < 0; };
  simulate_as_asked(model, options, counting);
  const long all = asked;
  REQUIRE(all > 300);  // three runs of 140 steps and more
  for (long when = 1; when <= all; when += 37) {
    asked = 0;
    SimulationHooks hooks;
    hooks.cancelled = [&] { return ++asked >= when; };
    INFO(when << " of " << all);
    CHECK(simulate_as_asked(model, options, hooks).status == RunStatus::stopped);
  }
}

// A position controller of k = 20 N m/rad holds an arm of I = 1 kg m^2; its command is 90 degrees at points
// 0.5 ms apart from 5.091 s to 5.131 s but for one, which is 180 degrees. What a spike of area A (in rad s)
// leaves is a swing of k A / (I omega); 1 - (omega 0.02 s)^2 / 2 of it, should the spline swing as far beside
// the spike.
TEST_CASE("no step passes over a spike in a dense table unseen") {
  std::string times = "[0", values = "[90";
  for (int i = -40; i <= 40; ++i) {
    times += ", " + std::to_string(5.111 + 5e-4 * i);
    values += i == 0 ? ", 180" : ", 90";
  }
  const Scene scene = read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [1, 0, 0], fixed = true}, {name = "H", position = [0, 0, 0], fixed = true},
         {name = "B", position = [0, 1, 0]}]
rods = [{nodes = ["H", "B"], mass = 3}]
[[constraints]]
kind = "plane"
nodes = ["B"]
normal = [0, 0, 1]
[[forces]]
kind = "motor"
nodes = ["A", "H", "B"]
axis = [0, 0, 1]
stall_torque = 1e6
no_load_speed = 1e9
control = "position"
proportional = 20
motion = "table"
times = )" + times + ", 10]\nvalues = " + values +
                                          R"(, 90]
[solver]
end_time = 10
)",
                                      "spike.toml");
  std::vector<double> t, y;
  for (int i = -40; i <= 40; ++i) t.push_back(5e-4 * i), y.push_back(i == 0 ? pi / 2 : 0.0);
  const TimeFunction spike = make_spline(t, y);
  double area = 0;  // of a spline, by Simpson's rule exactly
  for (std::size_t i = 1; i < t.size(); ++i)
    area += (t[i] - t[i - 1]) / 6 *
            (spike(t[i - 1]) + 4 * spike(0.5 * (t[i - 1] + t[i])) + spike(t[i] * (1 - 1e-15)));
  const double swing = 20 * area / std::sqrt(20.0);
  for (const double tolerance : {0.0, 1e-3, 1e-6}) {
    CAPTURE(tolerance);
    SolverOptions options = scene.solver;
    options.tolerance = tolerance;
    const Simulation run = simulate_as_asked(build_model(scene), options);
    REQUIRE(run.status == RunStatus::completed);
    const std::size_t last = run.trajectory.size() - 1;
    const double x = run.trajectory.node_positions(last)[6], v = run.trajectory.node_velocities(last)[6];
    CHECK(std::hypot(x, v / std::sqrt(20.0)) == Approx(swing).epsilon(1e-3));
  }
}

// Candidates whose steps are as long as the motion cost a hundred times what they should. Of the time that is
// asked for at least 1/4 is motion, or it is looked for in less: 35 steps over that are 30 or more up to the
// pose, however much time is asked for, and the same motion takes about the same solves.
TEST_CASE("a tolerance costs what the motion takes however much time is asked for") {
  for (const char* name : {"hoberman", "scissor_mast"}) {
    double deployed = 0;
    long solves = 0;
    for (const double end_time : {2.0, 60.0, 2000.0}) {
      Scene scene = read_scene_file(find_scene(name), {"solver.end_time=" + text_of(end_time)});
      scene.solver.model = "full";
      scene.solver.tolerance = 1e-6;
      const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
      INFO(name << " in " << end_time << " s: " << run.steps << " steps, " << run.trajectory.end_time()
                << " s");
      REQUIRE(run.status == RunStatus::deployed);
      CHECK(run.options.end_time == end_time);
      CHECK(run.position_estimate <= 1e-6);
      if (end_time > 2) CHECK(run.steps >= 30);
      if (solves == 0) deployed = run.trajectory.end_time(), solves = run.newton_iterations;
      CHECK(run.trajectory.end_time() == Approx(deployed).epsilon(0).margin(1e-5));
      CHECK(run.newton_iterations < 3 * solves);
    }
  }
}

}  // namespace tolerance_test
