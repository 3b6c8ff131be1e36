// SPDX-License-Identifier: BSD-3-Clause
// Adaptive steps follow what is light and swings fast beside what is heavy and has nearly all of the energy.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/study/table.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace adaptive_swing_test {
namespace {

const std::string solver = R"([solver]
adaptive = true
step = 0.05
turn = 0.1
end_time = 2
)";

// With two stages a swing is late by (h omega)^4 / 720 of its phase, h omega = turn: at `phase` [rad], twice
// that.
double allowed(double amplitude, double phase) {
  return 2 * amplitude * phase * std::pow(0.1, 4) / 720;
}

}  // namespace

// A pendulum of a tonne, and a gram on a spring that nothing joins with it, or hung on it: 0.05 J beside
// 10^4.
TEST_CASE("adaptive steps follow a light swing beside a heavy pendulum") {
  const Simulation run = run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1000},
         {name = "C", position = [5, 0, 0], fixed = true}, {name = "D", position = [6, 0, 0], mass = 0.001}]
rods = [{nodes = ["A", "B"], mass = 0}]
constraints = [{kind = "line", nodes = ["D"], direction = [1, 0, 0]}]
[[forces]]
kind = "spring"
nodes = ["C", "D"]
stiffness = 10
free_length = 0.9
[gravity]
acceleration = [0, 0, -9.81]
)" + solver);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings.empty());
  CHECK(end_positions(run)[9] == Approx(5.9 + 0.1 * std::cos(200.0)).epsilon(0).margin(allowed(0.1, 200)));
}

// Two masses in line on two springs, the outer one a billionth: what it does by the eigenvectors.
TEST_CASE("adaptive steps follow a light swing on a heavy one") {
  const double M = 1000, m = 1e-6, k1 = 1000, k2 = 1e-2;
  const Simulation run = run_scene(R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1.1, 0, 0], mass = 1000},
         {name = "B", position = [2.2, 0, 0], mass = 1e-6}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]},
               {kind = "line", nodes = ["B"], direction = [1, 0, 0]}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 1000
free_length = 1
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 0.01
free_length = 1
)" + solver);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.warnings.empty());
  const Eigen::Vector2d root(std::sqrt(M), std::sqrt(m));
  Eigen::Matrix2d K;
  K << (k1 + k2) / M, -k2 / std::sqrt(M * m), -k2 / std::sqrt(M * m), k2 / m;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> swings(K);
  Eigen::Vector2d parts = swings.eigenvectors().transpose() * root.cwiseProduct(Eigen::Vector2d(0.1, 0.2));
  for (int i = 0; i < 2; ++i) parts[i] *= std::cos(2 * std::sqrt(swings.eigenvalues()[i]));
  const Eigen::Vector2d u = (swings.eigenvectors() * parts).cwiseQuotient(root);
  CHECK(end_positions(run)[3] == Approx(1 + u[0]).epsilon(0).margin(allowed(0.1, 2)));
  CHECK(end_positions(run)[6] == Approx(2 + u[1]).epsilon(0).margin(allowed(0.1, 200)));
}

// A slide that is driven at a steady rate, and a gram on a spring behind it, let go with the slide's rate and
// a stretch of 0.1 m: x = 1 + 0.5 t + 0.1 cos(100 t). Without that stretch it only follows, which takes no
// short steps.
TEST_CASE("adaptive steps follow a swing behind a drive") {
  const auto run = [](const std::string& at) {
    return run_scene(R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], velocity = [0.5, 0, 0], mass = 1000},
         {name = "B", position = [1, 0, 0], velocity = [0.5, 0, 0], mass = 0.001}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]},
               {kind = "line", nodes = ["B"], direction = [1, 0, 0]},
               {kind = "coordinate", nodes = ["A"], direction = [1, 0, 0], motion = "rate", rate = 0.5}]
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 10
free_length = 1
)" + solver,
                     {"structure.nodes[1].position=[" + at + ",0,0]"});
  };
  const Simulation swings = run("1.1"), follows = run("1");
  REQUIRE(swings.status == RunStatus::completed);
  CHECK(swings.warnings.empty());
  CHECK(end_positions(swings)[3] == Approx(2 + 0.1 * std::cos(200.0)).epsilon(0).margin(allowed(0.1, 200)));
  CHECK(end_positions(follows)[3] == Approx(2).epsilon(1e-12));
  CHECK(follows.steps < 100);
}

// A mass that swings at 10/s and a gram behind it on a spring, damped beyond what swings, so that it lags by
// 5 cm: the mass is followed all the same, in steps of turn / 10 s. Against fixed ones of a tenth and five
// stages.
TEST_CASE("adaptive steps follow a swing beside what only lags behind it") {
  const std::string text = R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true}, {name = "A", position = [1.1, 0, 0], mass = 1},
         {name = "B", position = [2.1, 0, 0], mass = 0.001}]
constraints = [{kind = "line", nodes = ["A"], direction = [1, 0, 0]},
               {kind = "line", nodes = ["B"], direction = [1, 0, 0]}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 100
free_length = 1
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 10
damping = 0.5
free_length = 1
[[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 0
damping = 0.5
)" + solver;
  const VectorXd exact =
      end_positions(run_scene(text, {"solver.adaptive=false", "solver.step=0.001", "solver.stages=5"}));
  const Simulation run = run_scene(text);
  REQUIRE(run.status == RunStatus::completed);
  CHECK(static_cast<double>(run.steps) > 0.8 * 20 / 0.1);
  CHECK(end_positions(run)[3] == Approx(exact[3]).epsilon(0).margin(allowed(0.1, 20)));
}

// A mass that moves in a plane at a spring's end, which is pressed at times: its stiffness across the spring
// is negative then, and as much as that along it in some direction of motion. Against fixed steps of a tenth
// and five stages, which are of order 8: off by as much as phases of (h omega)^4 / 720 over some 40 rad, h
// omega = turn.
TEST_CASE("adaptive steps follow springs that are pressed and turn") {
  const std::string text = R"([structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [-0.529, 0.421, 0], mass = 0.00375},
         {name = "B", position = [-1.921, 0.943, 0], mass = 0.4139}]
constraints = [{kind = "line", nodes = ["A"], direction = [0.953, -0.420, 0]},
               {kind = "plane", nodes = ["B"], normal = [0, 0, 1]}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 0.5677
free_length = 1.826
[[forces]]
kind = "spring"
nodes = ["A", "B"]
stiffness = 3.212
free_length = 1.965
[gravity]
acceleration = [0, -9.81, 0]
[solver]
adaptive = true
step = 0.05
end_time = 1.5
)";
  const VectorXd exact =
      end_positions(run_scene(text, {"solver.adaptive=false", "solver.step=0.0005", "solver.stages=5"}));
  for (const double turn : {0.1, 0.05}) {
    const Simulation run = run_scene(text, {"solver.turn=" + exact_number(turn)});
    REQUIRE(run.status == RunStatus::completed);
    CHECK((end_positions(run) - exact).lpNorm<Eigen::Infinity>() < 40 * std::pow(turn, 4) / 720);
    CHECK(static_cast<double>(run.steps) < 40 / turn);
  }
}

}  // namespace adaptive_swing_test
