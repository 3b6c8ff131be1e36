// SPDX-License-Identifier: BSD-3-Clause
// References at any time, against closed forms.
#include "core/study/reference_motion.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/study/measured_run.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace reference_motion_test {

namespace {

constexpr double generous = 60;  // CPU time, under a sanitizer too [s]

// Node coordinates of a ladder whose uprights have turned by phi(t).
VectorXd ladder_positions(const exact::FourBarLadder& ladder, double t) {
  const double phi = ladder.angle(t);
  VectorXd q(6 * (ladder.windows + 1));
  for (int i = 0; i <= ladder.windows; ++i)
    q.segment<6>(6 * i) << i * ladder.length, 0, 0, i * ladder.length + ladder.length * std::sin(phi),
        ladder.length * std::cos(phi), 0;
  return q;
}

Simulation run_ladder(const std::shared_ptr<const Model>& model, const char* method, int stages, double step,
                      double end) {
  SolverOptions options = dvm_options(stages, step, end);
  options.method = method;
  return simulate(model, options);
}

}  // namespace

TEST_CASE("a reference tells the ladder's exact motion at any time") {
  const exact::FourBarLadder ladder{1, 6.0};
  const auto model = make_model(ladder_structure(1, 6.0));
  // It turns by some 14 rad, past four collinear poses, which stop the index-1 equations.
  const Simulation run = run_ladder(model, "dvm", 3, 0.02, 2.0);
  const ReferenceMotion reference = solve_reference_motion(model, run, generous, {});
  CHECK(reference.end() == 2.0);
  // Steps next to a collinear pose are ill-conditioned: two solutions of any order agree to 1e-11 m there, as
  // every run of the ladder does.
  constexpr double round_off = 1e-11;
  CHECK(reference.uncertainty() < 3 * round_off);
  for (const double t : {0.0, 0.013, 0.5, 0.777, 1.0 / 3, 1.9, 1.9999, 2.0})
    CHECK(node_distance(reference.positions(t), ladder_positions(ladder, t)) <
          reference.uncertainty() + round_off);
}

TEST_CASE("a run that ended before its first step has a start like any") {
  SimulationHooks hooks;
  hooks.cancelled = [] { return true; };
  const Simulation run = simulate(make_model(double_pendulum()), dvm_options(3, 0.02, 1.0), hooks);
  REQUIRE(run.trajectory.size() == 1);
  CHECK(one_sided_at_start(run).empty());
}

TEST_CASE("the position error of a run is its distance from the exact motion, whatever its steps") {
  const exact::FourBarLadder ladder{1, 1.0};
  const auto model = make_model(ladder_structure(1, 1.0));
  struct Case {
    const char* method;
    int stages;
    double step;
    bool adaptive;
  };
  const Simulation first = run_ladder(model, "dvm", 2, 0.2, 1.3);
  const ReferenceMotion reference = solve_reference_motion(model, first, generous, {});
  for (const Case& c : {Case{"dvm", 2, 0.2, false}, Case{"dvm", 3, 0.0371, false}, Case{"dvm", 4, 0.05, true},
                        Case{"rk4", 3, 0.01, false}, Case{"generalized_alpha", 3, 0.013, false}}) {
    SolverOptions options = dvm_options(c.stages, c.step, 1.3);
    options.method = c.method;
    options.adaptive = c.adaptive;
    const Simulation run = simulate(model, options);
    REQUIRE(run.status == RunStatus::completed);
    double truth = 0;
    for (std::size_t i = 0; i < run.trajectory.size(); ++i)
      truth = std::max(truth, node_distance(run.trajectory.node_positions(i),
                                            ladder_positions(ladder, run.trajectory.time(i))));
    INFO(c.method << " " << c.stages << " step " << c.step << ": " << truth << " m");
    CHECK(truth > 1e-11);  // something to measure
    CHECK(std::abs(position_error(run, reference) - truth) < 2 * reference.uncertainty() + 1e-13);
  }
}

TEST_CASE("a ring is judged up to shortly before it deploys, however coarse the run that asks") {
  const auto model = make_model(hoop_structure({{"model", std::string("sector")}}));
  const exact::Hoop exact = exact_hoop();
  const double deployed = exact.time(0);
  const Simulation coarse = simulate(model, dvm_options(2, 0.25, 6.0));
  const ReferenceMotion reference = solve_reference_motion(model, coarse, generous, {});
  // The probe of 5 nodes tells the time to 1e-6 s at least.
  CHECK(reference.end() == Approx(0.995 * deployed).epsilon(0).margin(1e-6));
  // As in the test of the reference itself: 1e-11 rad.
  for (const double t : {1.234, 3.3, 4.71, 4.89})
    CHECK(std::abs(model->structure.deployment.fold_angle(reference.positions(t)) - exact.angle(t)) < 1e-11);
  // One that deploys far too early has an error, one that broke off has none.
  Simulation early = simulate(model, dvm_options(2, 0.05, 6.0));
  CHECK(position_error(early, reference) > 1e-6);
  early.trajectory.pop_back();
  while (early.trajectory.end_time() > 3) early.trajectory.pop_back();
  CHECK(position_error(early, reference) > 0);
  early.status = RunStatus::failed;
  CHECK(std::isnan(position_error(early, reference)));
}

TEST_CASE("a reference by dvm agrees with one by extrapolation, which shares nothing with it") {
  const auto model = make_model(double_pendulum());
  const Simulation run = simulate(model, dvm_options(3, 0.02, 1.5));
  const ReferenceMotion motion = solve_reference_motion(model, run, generous, {});
  const Reference other = solve_reference(model, 1.5, 30, {});
  for (std::size_t i = 0; i < other.t.size(); ++i)
    CHECK(node_distance(motion.positions(other.t[i]), other.q[i]) <
          motion.uncertainty() + other.uncertainty + 1e-13);
  // And a run that meets the times has the same error by either, if it is largest at one of them.
  const Simulation aligned = simulate(model, dvm_options(3, 0.05, 1.5));
  CHECK(position_error(aligned, motion) == Approx(position_error(aligned.trajectory, other))
                                               .epsilon(0)
                                               .margin(motion.uncertainty() + other.uncertainty));
}

TEST_CASE("a reference that would take too long is given up at once") {
  const auto model = make_model(hoop_structure());
  SolverOptions options = dvm_options(3, 0.05, 4.0);
  const Simulation run = simulate(model, options);
  // The ring takes some 60 steps with 5 nodes to be probed: no machine does that in a tenth of a millisecond.
  CHECK_THROWS_WITH(solve_reference_motion(model, run, 1e-4, {}), Catch::Contains("s of CPU time"));
  StudyHooks hooks;
  hooks.cancelled = [] { return true; };
  CHECK_THROWS_AS(solve_reference_motion(model, run, generous, hooks), Cancelled);
}

TEST_CASE("what a reference is good enough for does not depend on the unit of length") {
  // Chaos: errors grow e-fold in about a second, from round-off to some 1e-10 of the size in 10 s and to more
  // than 1e-6 of it, where there is no reference, in 40 s.
  for (const double size : {0.01, 1.0, 100.0}) {
    const auto model = make_model(double_pendulum(size));
    INFO(size << " m");
    const Simulation run = simulate(model, dvm_options(3, 0.02, 10.0));
    CHECK(solve_reference_motion(model, run, generous, {}).uncertainty() < 1e-6 * size);
    CHECK_THROWS_WITH(
        solve_reference_motion(model, simulate(model, dvm_options(3, 0.02, 40.0)), generous, {}),
        Catch::Contains("the best two solutions differ by "));
  }
}

TEST_CASE("an end stop ends what one smooth motion can judge") {
  const Scene scene = read_scene_text(R"(
title = "a bob falls on a floor"
[structure]
kind = "pendulum"
angle = 90.0
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["bob"]
direction = [0, 0, 1]
min = -0.5
restitution = 0.5
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 4
step = 0.01
end_time = 2.0
)",
                                      "floor.toml", {});
  const auto model = build_model(scene);
  const Simulation run = simulate(model, scene.solver);
  REQUIRE(!run.events.empty());
  const JudgedSpan span = judged_span(run);
  CHECK(span.end == 0.995 * run.events.front().t);
  CHECK(span.before == "the first end stop");
  const ReferenceMotion reference = solve_reference_motion(model, run, generous, {});
  CHECK(reference.end() == Approx(span.end).epsilon(1e-6));
  // Bounces later on do not count: the run is of order 6 and its step small.
  CHECK(position_error(run, reference) < 1e-9);
}

}  // namespace reference_motion_test
