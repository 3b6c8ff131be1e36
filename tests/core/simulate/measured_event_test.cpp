// SPDX-License-Identifier: BSD-3-Clause
// The step that ends at a zero, of functions whose zero is known.
#include "core/simulate/measured_event.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace measured_event_test {

namespace {

struct Found {
  std::optional<State> state;
  int solves = 0;
};

// A state whose time is all that there is of it, from t = 2 on.
Found zero_of(const std::function<double(double)>& f, double h, double solvable = 1e9) {
  Found found;
  State from;
  from.t = 2;
  from.z = VectorXd::Constant(1, 7.5);
  found.state = step_to_zero(
      from, h, [&](const State& state) { return f(state.t - 2); },
      [&](double length, State& state) {
        CHECK(state.z[0] == 7.5);
        CHECK(length > 0);
        CHECK(length <= h);
        ++found.solves;
        state.t += length;
        return length <= solvable;
      });
  return found;
}

}  // namespace

TEST_CASE("a step ends at the zero of what is left, from either side, after few trials") {
  const std::vector<std::pair<std::function<double(double)>, double>> functions = {
      {[](double t) { return 0.3 - t; }, 0.3},
      {[](double t) { return std::cos(2 * t) - 0.1; }, 0.5 * std::acos(0.1)},
      {[](double t) { return 0.2 - t * t; }, std::sqrt(0.2)},
      {[](double t) { return std::exp(-3 * t) - 0.25; }, std::log(4.0) / 3},
      {[](double t) { return 0.05 - t * t * t * t; }, std::pow(0.05, 0.25)}};
  for (const auto& [f, zero] : functions) {
    const Found found = zero_of(f, 1.1);
    REQUIRE(found.state);
    // Values to 1e-15, times to the rounding of 2 + t.
    CHECK(found.state->t - 2 == Approx(zero).epsilon(0).margin(2e-15 * 4));
    CHECK(found.state->z[0] == 7.5);
    // Of order 1.44: six digits more with every four trials; a start on one side costs some.
    CHECK(found.solves <= 17);
  }
  // A straight line is met at once: the whole step, and that to the zero.
  CHECK(zero_of([](double t) { return 0.3 - t; }, 1.1).solves <= 4);
}

TEST_CASE("a step that does not get there, or cannot be solved, ends nowhere") {
  const auto line = [](double t) { return 0.3 - t; };
  CHECK_FALSE(zero_of(line, 0.29).state);
  CHECK(zero_of(line, 0.29).solves == 1);
  CHECK_FALSE(zero_of(line, 1.1, 1.0).state);
  CHECK_FALSE(zero_of([](double t) { return std::cos(2 * t) - 0.1; }, 1.1, 0.6).state);
  // Just there.
  const Found whole = zero_of([](double t) { return t < 0.3 - 1e-9 ? 0.3 - t : 0.0; }, 0.3);
  REQUIRE(whole.state);
  CHECK(whole.state->t == 2.3);
  CHECK(whole.solves == 1);
}

TEST_CASE("poses that a measure tells, or rods that give, are regular, flat ones of rigid rods are not") {
  Structure structure = testing::hoop_structure();
  CHECK_FALSE(deploys_regularly(structure));
  for (Rod& rod : structure.rods) rod.area = 1e-4, rod.youngs_modulus = 7e10;
  CHECK_FALSE(deploys_regularly(structure));  // a modulus shares forces, and no more
  for (Rod& rod : structure.rods) rod.gives = true;
  CHECK(deploys_regularly(structure));
  structure.rods.back().gives = false;
  CHECK_FALSE(deploys_regularly(structure));
  structure.deployment.measured = true;
  CHECK(deploys_regularly(structure));
}

// A mass that is drawn at 0.7 m/s^2 from x = 0.2 to 1.9, stowed at 0.2: what is left is (1.9 - x) / 1.7.
TEST_CASE("a step to a deployed pose less a margin ends there, and what is left falls at its rate") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [0.2, 0, 0], velocity = [1.3, 0, 0], mass = 2.5}]
[[structure.constraints]]
kind = "line"
nodes = ["A"]
direction = [1, 0, 0]
[[loads]]
nodes = ["A"]
force = [1.75, 0, 0]
)");
  Structure structure = model->structure;
  structure.deployment.measured = true;
  structure.deployment.measure = {MeasureKind::length, {0, 1}, Vec3::Zero(), 0.0, {}};
  structure.deployment.stowed = 0.2, structure.deployment.deployed = 1.9;
  const auto deploying = testing::make_model(structure);
  const auto method = find_method("dvm")->make(deploying->system, testing::dvm_options(3, 2, 2));
  const State start = initial_state(structure, deploying->system).state;
  CHECK(remaining_rate(*deploying, start) == Approx(-1.3 / 1.7));
  for (const double margin : {0.0, 0.15, -0.1}) {
    const auto end = step_to_deployed(*deploying, *method, start, 2.0, margin);
    REQUIRE(end);
    const double way = 1.7 * (1 - margin), t = (-1.3 + std::sqrt(1.69 + 1.4 * way)) / 0.7;
    CHECK(end->t == Approx(t).epsilon(1e-13));
    CHECK(remaining_rate(*deploying, *end) == Approx(-(1.3 + 0.7 * t) / 1.7).epsilon(1e-12));
  }
  CHECK_FALSE(step_to_deployed(*deploying, *method, start, 0.3, 0.0));
}

}  // namespace measured_event_test
