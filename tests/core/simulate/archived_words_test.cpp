// SPDX-License-Identifier: BSD-3-Clause
// What a run has told, met and counted before it is archived, it knows behind.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/stepper.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace archived_words_test {

namespace {

// A ball that bounces on a floor with a rope above it, stiffer than steps resolve; a mass that a spring pulls
// back and forth through its other end.
const std::string scene = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [0.21, 0, 0], velocity = [0.4, 0, 0], mass = 0.7},
         {name = "P", position = [2, 0, 1], fixed = true},
         {name = "B", position = [2, 0, 0.3], velocity = [0, 0, -1.5], mass = 1.3}]
rods = []
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[structure.constraints]]
kind = "line"
nodes = ["B"]
direction = [0, 0, 1]
[[forces]]
kind = "spring"
name = "through"
nodes = ["O", "A"]
stiffness = 30
free_length = 0.05
[[forces]]
kind = "spring"
name = "rope"
nodes = ["P", "B"]
stiffness = 20000
free_length = 0.9
tension_only = true
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["B"]
direction = [0, 0, 1]
min = -0.2
restitution = 0.7
[gravity]
acceleration = [0, 0, -2]
[solver]
stages = 3
step = 0.013
end_time = 2.6
)";

Simulation to_end(Stepper& stepper) {
  while (stepper.step()) {
  }
  return stepper.take();
}

}  // namespace

TEST_CASE("a run that was archived repeats no warning, and forgets neither those nor its events") {
  const Scene read = read_scene_text(scene, "s.toml");
  const auto model = build_model(read);
  Stepper plain(model, read.solver);
  const Simulation whole = to_end(plain);
  REQUIRE(whole.warnings.size() >= 2);
  const auto told = [&](const char* begin) {
    return std::count_if(whole.warnings.begin(), whole.warnings.end(),
                         [&](const std::string& w) { return w.find(begin) != std::string::npos; });
  };
  CHECK(told("the ends of through pass each other") == 1);
  CHECK(told("what rope holds swings on it in ") == 1);
  REQUIRE(whole.events.size() >= 4);
  for (const double cut : {0.1, 0.5, 1.1, 2.3}) {
    INFO("archived at " << cut << " s");
    Stepper first(model, read.solver);
    while (first.time() < cut) REQUIRE(first.step());
    Archive out;
    first.archive(out);
    Archive in(out.bytes());
    Stepper second(model, read.solver, in);
    CHECK(second.time() == first.time());
    const Simulation rest = to_end(second);
    CHECK(rest.warnings == whole.warnings);
    REQUIRE(rest.events.size() == whole.events.size());
    for (std::size_t i = 0; i < rest.events.size(); ++i) {
      CHECK(rest.events[i].name == whole.events[i].name);
      CHECK(rest.events[i].kind == whole.events[i].kind);
      CHECK(rest.events[i].element == whole.events[i].element);
      // Iterations begin anew behind an archive: round-off, which a dozen swings on the rope enlarge.
      CHECK(rest.events[i].t == Approx(whole.events[i].t).epsilon(0).margin(1e-11));
      CHECK(rest.events[i].energy_lost == Approx(whole.events[i].energy_lost).epsilon(0).margin(1e-9));
    }
    CHECK(rest.steps == whole.steps);
    CHECK(std::abs(rest.newton_iterations - whole.newton_iterations) <= 10);
    CHECK(std::abs(rest.factorisations - whole.factorisations) <= 10);
    CHECK(rest.trajectory.end_time() == whole.trajectory.end_time());
    CHECK((end_positions(rest) - end_positions(whole)).lpNorm<Eigen::Infinity>() < 1e-10);
  }
}

namespace {

// A winch draws a mass up to where a latch holds it; beside it a block slides along a rail until its friction
// holds it, is pushed on and held again, and a ball without rebound lies on a floor and is thrown up.
const std::string held = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [-1, 0, 0], fixed = true}, {name = "P", position = [0, 0, 0], fixed = true},
         {name = "B", position = [0, -2, 0], mass = 3},
         {name = "S", position = [5, 0, 0], velocity = [0.9, 0, 0], mass = 2},
         {name = "F", position = [9, 0.2, 0], mass = 1.1}]
rods = []
constraints = [{kind = "line", nodes = ["B"], direction = [0, 1, 0]},
               {kind = "line", nodes = ["S"], direction = [1, 0, 0]},
               {kind = "line", nodes = ["F"], direction = [0, 1, 0]}]
[gravity]
acceleration = [0, -9.81, 0]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["F"]
direction = [0, 1, 0]
min = 0.05
[[forces]]
kind = "cable"
name = "c"
nodes = ["A", "P", "B"]
axial_stiffness = 3000
damping = 30
motion = "rate"
rate = -0.8
ramp = 0.2
[[forces]]
kind = "friction"
name = "pad"
nodes = ["S"]
direction = [1, 0, 0]
kinetic = 2.5
static = 3.5
[[forces]]
kind = "load_over_time"
nodes = ["S", "F"]
force = [4.5, 14, 0]
times = [0.95, 1.0, 1.3, 1.35]
values = [0, 1, 1, 0]
[deployment]
measure = "length P B"
deployed = 1.2
[solver]
step = 0.01
stages = 4
end_time = 1.9
at_deployed = "latch"
)";

void check_same(const State& a, const State& b, double round_off) {
  CHECK(a.t == Approx(b.t).epsilon(0).margin(round_off));
  for (const auto part : {&State::z, &State::w, &State::lambda}) {
    REQUIRE((a.*part).size() == (b.*part).size());
    if ((a.*part).size() > 0)
      CHECK((a.*part - b.*part).lpNorm<Eigen::Infinity>() <=
            round_off * (1 + (b.*part).lpNorm<Eigen::Infinity>()));
  }
}

void check_same(const StepReport& a, const StepReport& b) {
  CHECK(a.status == b.status);
  CHECK(a.newton_iterations == b.newton_iterations);
  CHECK(a.factorisations == b.factorisations);
  CHECK(a.right_hand_sides == b.right_hand_sides);
  CHECK(a.residual == b.residual);
  CHECK(a.constraint_norm == b.constraint_norm);
  CHECK(a.singular_event == b.singular_event);
}

}  // namespace

TEST_CASE("what holds, rubs or has latched when a run is archived does so behind") {
  const Scene read = read_scene_text(held, "s.toml");
  const auto model = build_model(read);
  Stepper plain(model, read.solver);
  const Simulation whole = to_end(plain);
  INFO(whole.message);
  REQUIRE(whole.status == RunStatus::completed);
  std::string kinds;
  for (const Event& event : whole.events) kinds += event.kind + " ";
  INFO(kinds);
  for (const char* kind : {"taut", "contact", "stick", "slip", "free", "deployed", "latch"})
    CHECK(kinds.find(std::string(kind) + " ") != std::string::npos);
  std::vector<double> cuts;
  for (std::size_t i = 0; i + 1 < whole.events.size(); ++i)
    cuts.push_back(0.5 * (whole.events[i].t + whole.events[i + 1].t));  // between any two
  cuts.push_back(1.85);
  for (const double cut : cuts) {
    INFO("archived at " << cut << " s");
    Stepper first(model, read.solver);
    while (first.time() < cut) REQUIRE(first.step());
    Archive out;
    first.archive(out);
    Archive in(out.bytes());
    Stepper second(model, read.solver, in);
    const Trajectory &before = first.run().trajectory, &known = second.run().trajectory;
    REQUIRE(known.size() == before.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      check_same(known.state(i), before.state(i), 0.0);
      check_same(known.report(i), before.report(i));
    }
    CHECK(second.first_new() == first.first_new());
    const Structure &now = known.last_model().structure, &was = before.last_model().structure;
    REQUIRE(now.constraints.size() == was.constraints.size());
    for (std::size_t i = 0; i < now.constraints.size(); ++i)
      CHECK(now.constraints[i].name == was.constraints[i].name);
    const Simulation rest = to_end(second);
    CHECK(rest.status == whole.status);
    CHECK(rest.warnings == whole.warnings);
    REQUIRE(rest.events.size() == whole.events.size());
    for (std::size_t i = 0; i < rest.events.size(); ++i) {
      CHECK(rest.events[i].name == whole.events[i].name);
      CHECK(rest.events[i].t == Approx(whole.events[i].t).epsilon(0).margin(1e-10));
    }
    // Of forces of some 30 N round-off of steps, 1e-13 over 0.01 s squared.
    check_same(rest.trajectory.state(rest.trajectory.size() - 1),
               whole.trajectory.state(whole.trajectory.size() - 1), 1e-8);
  }
}

}  // namespace archived_words_test
