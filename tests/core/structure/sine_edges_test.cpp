// SPDX-License-Identifier: BSD-3-Clause
// When a sine begins, ends its ramp and turns round, and what rests there.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/held_nodes.hpp"
#include "core/simulate/time_grid.hpp"
#include "core/structure/prescribed_waves.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace sine_edges_test {

namespace {

// From 0.8 to 0 and back in 4 s, from rest at 0.5 s on.
TimeFunction from_rest() {
  TimeFunction f;
  f.kind = TimeFunction::Kind::sine, f.offset = 0.8, f.rise = -0.8, f.duration = 4, f.start = 0.5;
  return f;
}

std::vector<TimeEdge> edges_of(const TimeFunction& f, MeasureKind kind) {
  Structure s;
  s.constraints.resize(1);
  s.constraints[0].target = f;
  s.constraints[0].measure.kind = kind;
  return time_edges(s, 0.01);
}

}  // namespace

TEST_CASE("a sine has edges where it sets out and where it has grown") {
  TimeFunction f = from_rest();
  std::vector<TimeEdge> edges = edges_of(f, MeasureKind::length);
  REQUIRE(edges.size() == 1);
  CHECK(edges[0].t == 0.5);
  CHECK((edges[0].jump && edges[0].impact));  // its acceleration jumps, of others the velocity
  f.ramp = 1.2;
  edges = edges_of(f, MeasureKind::length);
  REQUIRE(edges.size() == 2);
  CHECK(edges[1].t == Approx(1.7));
  CHECK(std::ranges::none_of(edges, &TimeEdge::jump));
  f.ramp = 0, f.rise = 0;
  CHECK_FALSE(edges_of(f, MeasureKind::length)[0].jump);  // of no size
  // A ramp that no step tells from none is none, and the waves begin where they did.
  f = from_rest(), f.ramp = 1e-9;
  CHECK(make_jumps(f, 1e-7));
  CHECK((f.ramp == 0 && f.start == 0.5));
}

// Half a wave behind its start, at 2.5 s; the first time behind a ramp that is longer is a wave later.
TEST_CASE("a fold angle that turns round in the deployed pose has an edge there") {
  TimeFunction f = from_rest();
  for (const auto& [ramp, turn] : {std::pair{0.0, 2.5}, {1.0, 2.5}, {2.5, 6.5}}) {
    f.ramp = ramp;
    const std::vector<TimeEdge> edges = edges_of(f, MeasureKind::fold);
    REQUIRE(edges.size() == (ramp > 0 ? 3 : 2));
    CHECK(edges.back().t == Approx(turn).epsilon(1e-14));
    CHECK((edges.back().smooth && !edges.back().jump));
  }
  f.ramp = 0;
  CHECK(edges_of(f, MeasureKind::length).size() == 1);
  SolverOptions options;
  options.step = 0.1, options.end_time = 4;
  const TimeGrid ends(0, options, {{.t = 2.53, .smooth = true}});
  CHECK(ends.next(2.5).t == 2.53);
  options.at_deployed = "pass";
  CHECK(TimeGrid(0, options, {{.t = 2.53, .smooth = true}}).next(2.5).t == Approx(2.6));
  f.rise = -0.79;
  CHECK(edges_of(f, MeasureKind::fold).size() == 1);  // short of it
}

// Where a sine turns round its rate is zero, as that of a motion that has ended, which holds its node.
TEST_CASE("what a sine leads is not at rest where it turns round") {
  const std::string driven = R"(
[structure]
kind = "custom"
nodes = [{name = "S", position = [0, 0, 0], mass = 1}, {name = "M", position = [1, 0, 0], mass = 2}]
rods = [{nodes = ["S", "M"], mass = 1}]
constraints = [{kind = "line", nodes = ["S"], direction = [1, 0, 0]}]
[[constraints]]
kind = "coordinate"
name = "shake"
nodes = ["S"]
direction = [1, 0, 0]
motion = "smooth"
to = 0.1
duration = 0.25
)";
  const auto held = [](const Model& model, double t) {
    return nodes_at_rest(model, resting_coordinates(model.system, t, 0.01), t, 0.01);
  };
  CHECK_FALSE(held(*testing::model_of(driven), 0.25).empty());
  CHECK(held(*testing::model_of(driven, {"constraints[shake].motion=sine", "constraints[shake].amplitude=0.1",
                                         "constraints[shake].frequency=1"}),
             0.25)
            .empty());
}

TEST_CASE("the fastest wave is that of what has begun and has a size") {
  Structure s;
  s.constraints.resize(1);
  s.constraints[0].name = "slow", s.constraints[0].target = from_rest();
  s.forces.resize(1);
  s.forces[0].name = "fast";
  TimeFunction& fast = s.forces[0].motor.command = from_rest();
  fast.duration = 0.5, fast.start = 3;
  CHECK(std::isinf(fastest_wave(s, 0.4).period));
  CHECK(fastest_wave(s, 1).name == "slow");
  CHECK(fastest_wave(s, 3).name == "fast");
  CHECK(fastest_wave(s, 3).period == 0.5);
  fast.rise = 0;
  CHECK(fastest_wave(s, 3).name == "slow");
}

TEST_CASE("a sine turns round nowhere that times between which it does could tell") {
  TimeFunction f = from_rest();
  f.start = 0.5, f.duration = 1e-30;  // 5e13 waves between 0.5 and the double behind it
  CHECK(turning_times(f, f.start, f.start + f.duration).empty());
  f.duration = std::numeric_limits<double>::infinity();
  CHECK(turning_times(f, f.start, f.start + f.duration).empty());
  f.duration = 1e-14;  // still told apart there, where doubles are 1e-16 apart: one in half a wave
  const std::vector<double> turns = turning_times(f, f.start, f.start + f.duration);
  CHECK((turns.size() == 2 || turns.size() == 3));
}

}  // namespace sine_edges_test
