// SPDX-License-Identifier: BSD-3-Clause
// Newton's matrix is the derivative of the stage equations: next to their solution one iteration leaves the
// square of the error, where any term that is missing or off leaves its share.
#include "core/integrators/full_newton.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace full_newton_test {

namespace {

// Two rods from A and one more, which give or do not, and rows and forces that vary with everything: some
// stiff for steps of 20 ms.
const std::string linkage = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], fixed = true}, {name = "G", position = [0.2, -1.1, 0.3], fixed = true},
  {name = "B", position = [0.6, 0.8, 0.1], velocity = [0.8, -0.6, 0], mass = 0.7},
  {name = "C", position = [1.5, 1.1, 0.5], velocity = [0, 0.4, 0.9], mass = 1.1},
  {name = "D", position = [1.9, 0.2, 0.9], velocity = [0.3, 0.7, 0.1], mass = 0.4},
  {name = "P", position = [2, 2, 1], fixed = true}]
rods = [{nodes = ["A", "B"], mass = 0.9}, {nodes = ["B", "C"], mass = 0.6}, {nodes = ["C", "D"], mass = 0.3}]
[gravity]
acceleration = [0.3, -0.4, -9.1]
[[forces]]
kind = "spring"
nodes = ["P", "C"]
stiffness = 4300
damping = 170
free_length = 0.9
[[forces]]
kind = "torsion_spring"
nodes = ["G", "A", "B"]
axis = [0, 0, 1]
stiffness = 710
damping = 13
free_angle = 100
[[forces]]
kind = "winch"
name = "winch"
nodes = ["P", "B"]
stall_torque = 0.9
no_load_speed = 900
drum_radius = 0.07
inertia = 0.002
axial_stiffness = 3100
length = 1.7
damping = 2.1
[[forces]]
kind = "drag"
nodes = ["D"]
damping = 90
[[forces]]
kind = "follower"
rod = "B-C"
force = -900
times = [0, 0.02, 1]
values = [0.1, 2, 0.1]
)";

const char* const rows =
    "\n[[constraints]]\nkind = 'length'\nnodes = ['D', 'G']\nmotion = 'rate'\nrate = 0.3\n";

std::string scene(bool gives) {
  std::string text = linkage;
  if (gives) {
    const std::string rod = "{nodes = [\"B\", \"C\"], mass = 0.6}";
    text.replace(text.find(rod), rod.size(),
                 "{nodes = [\"B\", \"C\"], mass = 0.6, area = 1e-4, elastic = true, youngs_modulus = 3e8, "
                 "free_length = 0.97}");
    text.replace(text.find("kind = \"custom\""), 15, "kind = \"custom\"\ndamping_time = 0.004");
  }
  return text + rows;
}

struct Levels {
  double momentum, constraint, rods;

  explicit Levels(const StageEquations& eq)
      : momentum(eq.momentum_level()),
        constraint(eq.constraint_level()),
        rods(eq.rods.any() ? eq.rods.level() : 0) {}
};

// By so much of their size.
void disturb(StageEquations& eq, double share, std::mt19937& dice) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto move = [&](auto&& x, double size) {
    for (Index j = 0; j < x.cols(); ++j)
      for (Index i = 0; i < x.rows(); ++i) x(i, j) += share * size * uniform(dice);
  };
  move(eq.dX, 1.0);
  const double force = eq.lambda.lpNorm<Eigen::Infinity>();
  move(eq.lambda.leftCols(eq.at_ends ? 1 : eq.lambda.cols()), force);
  if (eq.rods.as_unknowns) move(eq.rods.tension, eq.rods.tension.lpNorm<Eigen::Infinity>());
}

}  // namespace

TEST_CASE("next to its solution an iteration by Newton's matrix leaves the square of the error") {
  std::mt19937 dice(14);
  for (const bool gives : {false, true}) {
    const auto model = testing::model_of(scene(gives));
    const State state = initial_state(model->structure, model->system).state;
    const System system = model->system.at(state);
    for (const auto& [stages, ends] : {std::pair{2, false}, {3, false}, {4, false}, {8, false}, {3, true}}) {
      CAPTURE(gives, stages, ends);
      const GalerkinCoefficients c("lobatto", stages);
      StageEquations eq(system, c, ends);
      eq.start(state.t, state.z, state.w, 0.02);
      for (int j = 0; j + 1 < stages; ++j) eq.dX.col(j) = 0.02 * c.basis.nodes()[j + 1] * state.w;
      if (gives && !ends) eq.take_rods_as_unknowns(true);
      FullNewton newton;
      StepReport report;
      REQUIRE(newton.solve(eq, 1.5, 30, true, report) == StepStatus::converged);
      CHECK(report.newton_iterations < 20);
      CHECK(eq.level() <= 30);
      disturb(eq, 1e-6, dice);
      eq.evaluate();
      const Levels before(eq);
      CHECK(before.momentum > 1e5);
      CHECK(before.constraint > 1e5);
      if (gives && !ends) CHECK(before.rods > 1e5);
      const VectorXd dX = eq.dX.reshaped(), lambda = eq.lambda.reshaped();
      const MatrixXd tension = eq.rods.tension;
      FullNewton fresh;
      StepReport one;
      CHECK(fresh.solve(eq, 1e-3 * eq.level(), 1, false, one) == StepStatus::converged);
      CHECK(one.newton_iterations == 1);
      CHECK(one.factorisations == 1);
      CHECK(one.right_hand_sides == stages - 1);
      // 1e-6 of the error, over sines of angles between rods; levels of some units are round-off.
      const Levels after(eq);
      CHECK(after.momentum <= 1e-3 * before.momentum + 30);
      CHECK(after.constraint <= 1e-3 * before.constraint + 30);
      CHECK(after.rods <= 1e-3 * before.rods + 30);
      // The last step's matrix serves as well, and is not asked for again: not for a step of another length.
      eq.dX.reshaped() = dX, eq.lambda.reshaped() = lambda, eq.rods.tension = tension;
      StepReport kept;
      const double tenth = 0.1 * std::max({before.momentum, before.constraint, before.rods});
      CHECK(newton.solve(eq, tenth, 30, true, kept) == StepStatus::converged);
      CHECK(kept.newton_iterations == 1);
      CHECK(kept.factorisations == 0);
      eq.start(state.t, state.z, state.w, 0.01);
      StepReport shorter;
      CHECK(newton.solve(eq, 1.5, 30, true, shorter) == StepStatus::converged);
      CHECK(shorter.factorisations >= 1);
      // What is no number is as far off as can be.
      eq.lambda(0, 0) = std::numeric_limits<double>::quiet_NaN();
      eq.evaluate();
      CHECK(std::isinf(eq.level()));
      eq.lambda(0, 0) = 0, eq.dX(0, stages - 2) = std::numeric_limits<double>::quiet_NaN();
      CHECK(newton.solve(eq, 1.5, 30, true, shorter) == StepStatus::not_finite);
    }
  }
}

// Doubling its digits an iteration takes five from 1e-1 to round-off, those that try without the forces first
// three more; by a matrix that stays for some iterations or is kept, twice as many.
TEST_CASE("steps on forces that are stiff for them end after as many iterations as Newton's method takes") {
  for (const auto& [solver, most] :
       {std::pair{"generalized_alpha'\nstep = 0.005", 9}, {"dvm'\nstep = 0.02", 16}})
    for (const bool gives : {false, true}) {
      const Simulation run =
          testing::run_scene(scene(gives) + "[solver]\nend_time = 0.2\nmethod = '" + solver + "\n");
      INFO(solver << ", " << gives << ": " << run.newton_iterations << " in " << run.steps << " steps");
      REQUIRE(run.status == RunStatus::completed);
      CHECK(run.newton_iterations <= most * run.steps);
    }
}

}  // namespace full_newton_test
