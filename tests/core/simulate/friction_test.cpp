// SPDX-License-Identifier: BSD-3-Clause
// Dry friction against closed forms: it holds, slips and turns round at located times.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/simulate/stepper.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/coulomb_oscillator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace friction_test {

namespace {

using testing::end_positions, testing::error_of, testing::run_scene;

const std::string oscillator =
    testing::coulomb_oscillator + "[solver]\nstages = 5\nstep = 0.01\nend_time = 9\n";

std::vector<Event> events_of(const Simulation& run, const std::string& kind) {
  std::vector<Event> out;
  for (const Event& event : run.events)
    if (event.kind == kind) out.push_back(event);
  return out;
}

double at(const Simulation& run, double t) {
  return run.trajectory.positions_at(t)[3];
}

// Half swings of pi / 10 s about +-0.01 m: x_n = (-1)^n (0.495 - 0.02 n), at rest from n = 25.
void check_oscillator(const Simulation& run, double tolerance) {
  REQUIRE(run.status == RunStatus::completed);
  const auto turns = events_of(run, "reversal"), rests = events_of(run, "stick");
  REQUIRE(turns.size() == 24);
  REQUIRE(rests.size() == 1);
  for (std::size_t n = 1; n <= 25; ++n) {
    const Event& event = n < 25 ? turns[n - 1] : rests[0];
    CHECK(event.element == "pad");
    CHECK(event.t == Approx(static_cast<double>(n) * pi / 10).epsilon(0).margin(10 * tolerance));
    const double x = 2 + (n % 2 ? -1 : 1) * (0.495 - 0.02 * static_cast<double>(n));
    CHECK(at(run, event.t) == Approx(x).epsilon(0).margin(tolerance));
  }
  CHECK(end_positions(run)[3] == Approx(2.005).epsilon(0).margin(tolerance));
}

}  // namespace

TEST_CASE("an oscillator with dry friction turns round and comes to rest where Coulomb says") {
  const Simulation run = run_scene(oscillator);
  INFO(run.message);
  check_oscillator(run, 1e-10);
  const Diagnostics d = diagnose(run);
  // 1 N along the 12 m of its way: 0.495 + 0.475, 0.475 + 0.455, ... 0.015 - 0.005, of 12.25 J. A quadratic
  // energy that Gauss's rule keeps to round-off of 900 steps.
  CHECK(d.at("dissipated_J").values.back() == Approx(50 * (0.495 * 0.495 - 0.005 * 0.005)).epsilon(1e-12));
  CHECK(testing::largest(d, "energy_balance_J") <= 1e-11);
  CHECK(run.events.size() == 25);
}

TEST_CASE("every method takes friction to its own order, and a tolerance is kept in few steps") {
  for (const Method& method : methods()) {
    const bool second = method.name == "generalized_alpha";
    INFO(method.name);
    // (omega h)^p of 0.5 m over 25 half swings.
    check_oscillator(run_scene(oscillator, {"solver.method=" + std::string(method.name), "solver.stages=4",
                                            second ? "solver.step=0.0005" : "solver.step=0.002"}),
                     second ? 2e-4 : 1e-6);
  }
  const Scene scene = read_scene_text(oscillator, "s.toml", {"solver.tolerance=1e-8"});
  const Simulation picked = simulate_as_asked(build_model(scene), scene.solver);
  check_oscillator(picked, 1e-8);
  // 7.85 s of 10 rad/s and 26 events: some 50 steps and what the events divide.
  CHECK(picked.steps < 500);
}

TEST_CASE("a stepper goes through sticking and slipping as a run does") {
  const Scene scene = read_scene_text(oscillator, "s.toml");
  const auto model = build_model(scene);
  Stepper stepper(model, scene.solver);
  REQUIRE(stepper.advance_to(4.321));
  const double x = stepper.model().system.coordinates() > 0 ? stepper.state().z[0] : 0;
  const Simulation run = run_scene(oscillator);
  CHECK(x == Approx(at(run, 4.321)).epsilon(0).margin(1e-10));
  // From the rest, again: it stays.
  Stepper rested(model, scene.solver, run.trajectory.state_at(8.5));
  CHECK(rested.advance_to(8.9));
  CHECK(rested.state().z[0] == Approx(2.005).epsilon(0).margin(1e-10));
  CHECK(rested.run().events.empty());
}

TEST_CASE("a block dragged by a spring sticks and slips as its two coefficients say") {
  // The spring's end goes at V = 0.3 m/s, k = 50 N/m, m = 2 kg, static 4 N, kinetic 2.5 N.
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "D", position = [3, 0, 0], mass = 1},
  {name = "A", position = [1, 0, 0], mass = 2}]
[[constraints]]
kind = "coordinate"
nodes = ["D"]
direction = [1, 0, 0]
motion = "rate"
rate = 0.3
[[forces]]
kind = "spring"
nodes = ["A", "D"]
stiffness = 50
[[forces]]
kind = "friction"
name = "floor"
nodes = ["A"]
direction = [1, 0, 0]
kinetic = 2.5
static = 4
[solver]
stages = 4
step = 0.02
end_time = 3
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const double k = 50, V = 0.3, omega = std::sqrt(k / 2), drop = 4 - 2.5;
  const double stuck = 4 / (k * V);  // until the spring pulls with 4 N
  // Slipping by y = V s + drop/k (1 - cos(omega s)) - V/omega sin(omega s), until y' = 0.
  const double slides = (2 * pi - 2 * std::atan(drop * omega / (k * V))) / omega;
  const double way =
      V * slides + drop / k * (1 - std::cos(omega * slides)) - V / omega * std::sin(omega * slides);
  // The spring is then shorter by 2 drop, and stretched again to 4 N.
  const double again = (way / V - slides) * 1.0;
  const auto slips = events_of(run, "slip"), sticks = events_of(run, "stick");
  REQUIRE(slips.size() >= 2);
  REQUIRE(sticks.size() >= 1);
  CHECK(slips[0].t == Approx(stuck).epsilon(1e-9));
  CHECK(sticks[0].t == Approx(stuck + slides).epsilon(1e-8));
  CHECK(at(run, stuck + slides + 1e-3) == Approx(1 + way).epsilon(0).margin(1e-8));
  CHECK(slips[1].t == Approx(stuck + slides + again).epsilon(1e-8));
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-8);
}

TEST_CASE("two frictions on one hinge are one of their sum, and one on a driven measure follows the drive") {
  const std::string half = R"(
[[forces]]
kind = "friction"
name = "second pad"
nodes = ["A"]
direction = [1, 0, 0]
kinetic = 0.4
)";
  const Simulation run = run_scene(oscillator + half, {"forces[1].kinetic=0.6"});
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings.empty());
  CHECK(end_positions(run)[3] == Approx(2.005).epsilon(0).margin(1e-10));
  for (const char* name : {"pad", "second pad"}) {
    std::size_t turns = 0;
    for (const Event& event : run.events) turns += event.element == name && event.kind == "reversal";
    CHECK(turns == 24);
  }
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-11);
  // Together they hold 1.7 N, whatever each of them would hold alone, and give 0.8 N while they slip. A pull
  // of 1.3 N/s from the spring's free length on gets there at 1.7 / 1.3 s.
  const std::vector<std::string> pulled = {"structure.nodes.A.position=[2,0,0]", "solver.end_time=2"};
  const std::string load = R"(
[[forces]]
kind = "load_over_time"
nodes = ["A"]
force = [1, 0, 0]
times = [0, 2]
values = [0, 2.6]
)";
  std::vector<std::string> both = pulled, one = pulled;
  both.insert(both.end(), {"forces[1].kinetic=0.6", "forces[1].static=1.5", "forces[2].static=0.2",
                           "forces[2].kinetic=0.2"});
  one.insert(one.end(), {"forces[1].kinetic=0.8", "forces[1].static=1.7"});
  const Simulation two = run_scene(oscillator + half + load, both), alone = run_scene(oscillator + load, one);
  for (const Simulation* r : {&two, &alone}) {
    INFO(r->message);
    REQUIRE(r->status == RunStatus::completed);
    REQUIRE(!events_of(*r, "slip").empty());
    CHECK(events_of(*r, "slip")[0].t == Approx(1.7 / 1.3).epsilon(1e-9));
  }
  CHECK(end_positions(two)[3] == Approx(end_positions(alone)[3]).epsilon(1e-12));
  // A motor takes the block 0.7 m there and back: it pays 1 N all the way.
  const Simulation driven = run_scene(oscillator + R"(
[[constraints]]
kind = "coordinate"
name = "motor"
nodes = ["A"]
direction = [1, 0, 0]
motion = "table"
times = [0, 1, 2]
values = [2.495, 3.195, 2.495]
)",
                                      {"solver.end_time=3"});
  INFO(driven.message);
  REQUIRE(driven.status == RunStatus::completed);
  const Diagnostics d = diagnose(driven);
  CHECK(d.at("dissipated_J").values.back() == Approx(1.4).epsilon(1e-9));
  CHECK(d.at("drive_work_J").values.back() == Approx(1.4).epsilon(1e-6));
  CHECK(events_of(driven, "reversal").size() == 1);
}

TEST_CASE("friction turns round once at a time, however far a method drifts from the constraints") {
  const std::string swing = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [1, 0, 0], mass = 0.5},
  {name = "B", position = [1.6, 0.4, 0], mass = 1.2}]
rods = [{name = "a", nodes = ["O", "A"], mass = 0.3}, {name = "b", nodes = ["A", "B"], mass = 0.2}]
[[forces]]
kind = "friction"
nodes = ["O", "A", "B"]
kinetic = 0.5
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.002
end_time = 3
)";
  const std::vector<Event> turns = events_of(run_scene(swing), "reversal");
  REQUIRE(turns.size() >= 5);
  for (const char* method : {"rk4", "rk4_baumgarte", "rk4_projected"}) {
    std::vector<Event> there =
        events_of(run_scene(swing, {std::string("solver.method=") + method}), "reversal");
    // Where it begins to slip, at 0.27 s, the sense is that of the drift for some 1e-9 s with Baumgarte's
    // terms.
    std::erase_if(there, [](const Event& event) { return event.t < 0.5; });
    INFO(method);
    REQUIRE(there.size() == turns.size());
    // The hinge turns at 10 rad/s: rk4 in steps of 2 ms is 0.02^4 off, and swings of 3 s take that up some
    // times.
    for (std::size_t i = 0; i < turns.size(); ++i)
      CHECK(there[i].t == Approx(turns[i].t).epsilon(0).margin(1e-5));
  }
}

TEST_CASE("no impulse passes through friction that sticks") {
  // Two masses on one line fall together, held to one another by 3 N; the lower one is thrown back by a stop
  // at half its speed, the upper one goes on and is slowed down by 3 N until both have one speed.
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0.8], mass = 2},
  {name = "B", position = [0, 0, 5], mass = 3}]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["A"]
direction = [0, 0, 1]
min = 0
restitution = 0.5
[[forces]]
kind = "friction"
name = "clamp"
nodes = ["A", "B"]
direction = [0, 0, 1]
kinetic = 3
[gravity]
acceleration = [0, 0, -10]
[solver]
stages = 4
step = 0.01
end_time = 0.5
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const auto hits = events_of(run, "contact");
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].t == Approx(0.4).epsilon(1e-11));
  CHECK(hits[0].energy_lost == Approx(0.5 * 2 * 16 * 0.75).epsilon(1e-10));
  const std::size_t slips = static_cast<std::size_t>(
      std::find_if(run.events.begin(), run.events.end(), [](const Event& e) { return e.kind == "slip"; }) -
      run.events.begin());
  REQUIRE(slips < run.events.size());
  CHECK(run.events[slips].t == hits[0].t);
  // From then on A has 2 m/s and -10 - 1.5 m/s^2, B -4 m/s and -10 + 1 m/s^2.
  const double s = 0.1;
  CHECK(end_positions(run)[2] == Approx(2 * s - 0.5 * 11.5 * s * s).epsilon(0).margin(1e-10));
  CHECK(end_positions(run)[5] == Approx(5 - 0.8 - 4 * s - 0.5 * 9 * s * s).epsilon(0).margin(1e-10));
}

TEST_CASE("a hinge with friction holds its angle and turns any number of times") {
  // A rod of 3 kg and 1.3 m about z at 30 rad/s, slowed down by 2 N m; I = m l^2 / 3. Sixty turns.
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "P", position = [1, 0, 0], fixed = true},
  {name = "A", position = [0, 1.3, 0], velocity = [-39, 0, 0]}]
rods = [{name = "arm", nodes = ["O", "A"], mass = 3}]
constraints = [{kind = "plane", nodes = ["A"], normal = [0, 0, 1]}]
[[forces]]
kind = "friction"
name = "hinge"
nodes = ["P", "O", "A"]
axis = [0, 0, 1]
kinetic = 2
[solver]
stages = 5
step = 0.005
end_time = 26
)");
  INFO(run.message);
  REQUIRE(run.status == RunStatus::completed);
  const double inertia = 3 * 1.69 / 3, stop = 30 * inertia / 2, angle = 0.5 * 30 * stop;
  const auto sticks = events_of(run, "stick");
  REQUIRE(sticks.size() == 1);
  CHECK(sticks[0].t == Approx(stop).epsilon(1e-9));
  const VectorXd end = end_positions(run);
  CHECK(std::remainder(std::atan2(end[7], end[6]) - pi / 2 - angle, 2 * pi) ==
        Approx(0).epsilon(0).margin(1e-7));
  CHECK(testing::largest(diagnose(run), "energy_balance_J") <= 1e-9 * 0.5 * inertia * 900);
}

TEST_CASE("friction that cannot be is refused with its place and a cure") {
  const auto refused = [](const std::string& change, const char* why) {
    const std::string error = error_of(oscillator, {change});
    INFO(error);
    return error.find(why) != std::string::npos;
  };
  CHECK(refused("forces[1].kinetic=-1", "kinetic: must be"));
  CHECK(refused("forces[1].static=0.5", "static: must be at least kinetic"));
  CHECK(refused("forces[1].direction=[0,0,0]", "direction: is missing"));
  CHECK(refused("forces[1].nodes=[\"A\",\"B\",\"C\",\"D\"]", "nodes: must be 1, 2 or 3 names"));
}

}  // namespace friction_test
