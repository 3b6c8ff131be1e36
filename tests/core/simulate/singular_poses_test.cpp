// SPDX-License-Identifier: BSD-3-Clause
// Singular poses on the way, against the exact times of the ladder's collinear ones.
#include "core/simulate/singular_poses.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "core/math/singular_values.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace singular_poses_test {

namespace {

std::vector<Event> singular_events(Simulation& run) {
  record_singular_poses(run);
  std::vector<Event> found;
  for (const Event& e : run.events)
    if (e.name == "singular pose") found.push_back(e);
  return found;
}

SmallestSingularValue of_all(const System& system, Index redundant) {
  const auto jacobian = std::make_shared<JacobianInPoses>(system);
  std::vector<Index> all(static_cast<std::size_t>(system.solved_coordinates()));
  std::iota(all.begin(), all.end(), Index{0});
  return {jacobian, SparsePart(jacobian->pattern(), std::move(all)), redundant};
}

}  // namespace

// Parallelograms that turn evenly, the k-th one at k rad/s from -0.5 rad on: flat at 0.5 s / k. Beside them a
// truss whose rows are always weaker than theirs in any state.
TEST_CASE("singular poses of linkages are told beside what is always near one, however many there are") {
  for (const auto& [slowest, fastest] : {std::pair{1, 1}, {1, 2}, {40, 120}}) {
    CAPTURE(slowest, fastest);
    Simulation run = run_scene(R"toml([variables]
a = )toml" + std::to_string(slowest) +
                               "\nn = " + std::to_string(fastest) +
                               R"toml(
c = "=cos(0.5)"
s = "=sin(0.5)"
[structure]
kind = "custom"
nodes = [{repeat = {i = "a:n+1"}, name = "A{i}", position = [0, "=i", 0], fixed = true},
  {repeat = {i = "a:n+1"}, name = "D{i}", position = [2, "=i", 0], fixed = true},
  {repeat = {i = "a:n+1"}, name = "B{i}", position = ["=c", "=i", "=-s"], velocity = ["=i*s", 0, "=i*c"]},
  {repeat = {i = "a:n+1"}, name = "C{i}", position = ["=2+c", "=i", "=-s"], velocity = ["=i*s", 0, "=i*c"]},
  {name = "T0", position = [0, 0, 0], fixed = true}, {name = "T1", position = [1, 0, -1e-4]},
  {name = "T2", position = [2, 0, 0], fixed = true}]
rods = [{repeat = {i = "a:n+1"}, nodes = ["A{i}", "B{i}"], mass = 1}, {repeat = {i = "a:n+1"}, nodes = ["B{i}", "C{i}"], mass = 1},
  {repeat = {i = "a:n+1"}, nodes = ["C{i}", "D{i}"], mass = 1}, {nodes = ["T0", "T1"], mass = 1}, {nodes = ["T1", "T2"], mass = 1}]
[[structure.constraints]]
kind = "plane"
nodes = ["B*", "C*", "T1"]
normal = [0, 1, 0]
[solver]
stages = 4
step = 1e-3
end_time = )toml" + std::string(slowest > 1 ? "0.0145" : "0.52"));
    REQUIRE(run.status == RunStatus::completed);
    std::vector<double> expected;
    for (int k = fastest; k >= slowest; --k)
      for (int turn = 0; (0.5 + turn * pi) / k < run.trajectory.end_time(); ++turn)
        expected.push_back((0.5 + turn * pi) / k);
    std::ranges::sort(expected);
    const std::vector<Event> events = singular_events(run);
    REQUIRE(events.size() == expected.size());
    // A cubic through a step of 0.12 rad is off by its fourth power over 384 of that.
    for (std::size_t k = 0; k < events.size(); ++k) CHECK(std::abs(events[k].t - expected[k]) < 1e-7);
  }
}

TEST_CASE("the ladder's collinear poses are events, each at its time and none else") {
  struct Case {
    int windows;
    double speed, end;
  };
  for (const Case& c : {Case{1, 1.0, 10.0}, Case{1, 30.0, 10.0}, Case{2, 1.0, 10.0}, Case{40, 30.0, 1.0}}) {
    Simulation run = simulate(make_model(ladder_structure(c.windows, c.speed)), dvm_options(6, 0.01, c.end));
    REQUIRE(run.status == RunStatus::completed);
    const exact::FourBarLadder ladder{c.windows, c.speed};
    const std::vector<Event> events = singular_events(run);
    INFO("N = " << c.windows << ", v = " << c.speed << " m/s");
    // All rods lie along x where the uprights have turned by 90, 270, 450, ... deg.
    const double turns = (ladder.angle(c.end) - 0.5 * M_PI) / M_PI;
    REQUIRE(events.size() == static_cast<std::size_t>(std::floor(turns)) + 1);
    for (std::size_t k = 0; k < events.size(); ++k) {
      // Cubic Hermite interpolation of a step that turns by a leaves a^4 / 384: 2e-5 rad at 0.3 rad, 6e-8 at
      // 0.07.
      const double off = ladder.angle(events[k].t) - (0.5 + static_cast<double>(k)) * M_PI;
      CHECK(std::abs(off) <= (c.speed > 10 ? 1e-4 : 1e-6));
      CHECK(events[k].singular_value <= 1e-4);
    }
  }
}

TEST_CASE(
    "what is redundant everywhere is no singular pose, the ring's deployed one is, where it is passed") {
  SolverOptions options = dvm_options(4, 0.01, 5.2);
  Simulation stopped = simulate(make_model(hoop_structure()), options);
  CHECK(structural_redundancy(stopped.trajectory, 0, stopped.trajectory.size() - 1) == 7);
  CHECK(singular_events(stopped).empty());

  options.at_deployed = "pass";
  Simulation passing = simulate(make_model(hoop_structure()), options);
  REQUIRE(passing.status == RunStatus::completed);
  const std::vector<Event> events = singular_events(passing);
  REQUIRE(events.size() == 1);
  // 5 rad/s at h = 0.01: an interpolation error of 2e-8 rad; the step across is longer than the others.
  CHECK(events[0].t == Approx(exact_hoop().time(0)).epsilon(0).margin(1e-5));
}

TEST_CASE("singular poses are found inside steps that turn far, and none in the rounding of a slow start") {
  // 30 m/s: 30 rad/s, so that a step of 0.05 s of eight stages turns by 1.5 rad and steps of 0.03 s by 0.9.
  const exact::FourBarLadder ladder{1, 30.0};
  for (const auto& [stages, step] : {std::pair{8, 0.05}, std::pair{6, 0.03}}) {
    Simulation run = simulate(make_model(ladder_structure(1, 30.0)), dvm_options(stages, step, 2.0));
    REQUIRE(run.status == RunStatus::completed);
    const std::vector<Event> events = singular_events(run);
    INFO(stages << " stages, " << step << " s");
    const double turns = (ladder.angle(2.0) - 0.5 * M_PI) / M_PI;
    REQUIRE(events.size() == static_cast<std::size_t>(std::floor(turns)) + 1);
    for (std::size_t k = 0; k < events.size(); ++k)
      CHECK(std::abs(ladder.angle(events[k].t) - (0.5 + static_cast<double>(k)) * M_PI) <= 1e-3);
  }
  for (const double step : {0.003, 0.03}) {
    Simulation ring =
        simulate(make_model(hoop_structure({{"fold_angle", 89.999}})), dvm_options(4, step, 0.3));
    CHECK(singular_events(ring).empty());
  }
}

// A Hoberman ring that goes on opening: its dip is half a step wide, between two other singular values that
// are the smallest on both sides of it.
TEST_CASE("a dip that is narrower than the steps is followed to its bottom") {
  std::vector<Event> found;
  for (const double step : {0.002, 0.005}) {
    const Scene scene =
        read_scene_text("[structure]\nkind = 'hoberman'\n[solver]\nend_time = 1.0\n", "s", {});
    SolverOptions options = dvm_options(5, step, 1.0);
    options.at_deployed = "pass";
    Simulation run = simulate(build_model(scene), options);
    REQUIRE(run.status == RunStatus::completed);
    const std::vector<Event> events = singular_events(run);
    REQUIRE(events.size() == 1);
    // sigma goes with 23 / s there, and the bottom is looked for to 1e-4 of two steps, 1e-6 s.
    CHECK(events[0].singular_value <= 2.5e-5);
    found.push_back(events[0]);
  }
  // Both motions are right to 1e-8 m at 5 m/s, at the longer step by order 8.
  CHECK(std::abs(found[0].t - found[1].t) <= 1e-8);
}

TEST_CASE("a swing without singular poses has no such event") {
  Simulation run = simulate(make_model(double_pendulum()), dvm_options(4, 0.01, 5.0));
  CHECK(singular_events(run).empty());
}

TEST_CASE("inverse iteration finds the smallest singular value that is not zero everywhere") {
  const auto model = make_model(hoop_structure());
  const System& system = model->system;
  const Simulation run = simulate(model, dvm_options(4, 0.01, 4.5));
  SmallestSingularValue sigma = of_all(system, 7);
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  for (std::size_t i = 0; i < run.trajectory.size(); i += 50) {
    system.jacobian(run.trajectory.node_positions(i), G, scratch);
    for (Index r = 0; r < G.rows(); ++r) G.row(r) /= G.row(r).norm();
    const VectorXd dense = singular_values(MatrixXd(G));
    // Warm-started over 50 steps at once, two iterations leave less than a hundredth.
    CHECK(sigma.at(run.trajectory.state(i).z) == Approx(dense[system.constraints() - 7 - 1]).epsilon(0.01));
  }
}

// Weyl: no singular value changes by more than the norm of what the matrix changes by, which is what lets a
// search pass over poses. Against the singular values of dense matrices.
TEST_CASE("no singular value changes by more than the Jacobian has moved") {
  const auto model = make_model(hoop_structure());
  const System& system = model->system;
  const Simulation run = simulate(model, dvm_options(4, 0.01, 4.5));
  SmallestSingularValue sigma = of_all(system, 7);
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  MatrixXd before;
  VectorXd dense_before;
  for (std::size_t i = 3; i < run.trajectory.size(); i += 37) {
    system.jacobian(run.trajectory.node_positions(i), G, scratch);
    for (Index r = 0; r < G.rows(); ++r) G.row(r) /= G.row(r).norm();
    const MatrixXd now(G);
    const VectorXd dense = singular_values(now);
    const double moved = sigma.moved(run.trajectory.state(i).z);
    if (before.size() > 0) {
      CHECK(moved == Approx((now - before).norm()).epsilon(1e-12));
      CHECK((dense - dense_before).lpNorm<Eigen::Infinity>() <= moved);
    } else {
      CHECK(std::isinf(moved));
    }
    before = now;
    dense_before = dense;
  }
}

// A rod between two fixed nodes beside a mass on springs: the only row holds nothing that moves.
TEST_CASE("rods that cannot move have no singular poses to look for") {
  const Scene scene = read_scene_text(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], fixed = true},
         {name = "C", position = [0.5, 1, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[forces]]
kind = "spring"
nodes = ["A", "C"]
stiffness = 100
free_length = 0.9
[[forces]]
kind = "spring"
nodes = ["B", "C"]
stiffness = 100
free_length = 0.9
[solver]
step = 0.01
end_time = 0.5
)",
                                      "s", {});
  Simulation run = simulate(build_model(scene), scene.solver);
  REQUIRE(run.status == RunStatus::completed);
  const System& system = run.trajectory.model(0).system;
  const Index redundant = structural_redundancy(run.trajectory, 0, run.trajectory.size() - 1);
  CHECK(redundant == system.constraints());
  CHECK(of_all(system, redundant).all_zeros());
  CHECK_FALSE(of_all(make_model(hoop_structure())->system, 7).all_zeros());
  CHECK(singular_events(run).empty());
}

}  // namespace singular_poses_test
