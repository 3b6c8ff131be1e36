// SPDX-License-Identifier: BSD-3-Clause
// Runs step by step, and what is shown between steps.
#include "core/simulate/stepper.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/simulate/pushed_model.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace stepper_test {

TEST_CASE("a run step by step is the run of simulate, and can go on from any of its states") {
  const auto model = make_model(double_pendulum());
  const SolverOptions options = dvm_options(4, 0.01, 1.0);
  const Simulation whole = simulate(model, options);
  std::vector<double> seen;
  Stepper stepper(model, options);
  stepper.on_step([&](const State& s, const StepReport& report) {
    CHECK(report.ok());
    seen.push_back(s.t);
  });
  while (stepper.step()) {
  }
  CHECK(stepper.run().status == RunStatus::completed);
  REQUIRE(seen.size() == 100);
  CHECK(seen.back() == 1.0);
  CHECK(stepper.state().z == whole.trajectory.state(100).z);
  // From the middle: the same steps, but for their predictors, which leave round-off.
  Stepper second(model, options, whole.trajectory.state(50));
  while (second.step()) {
  }
  CHECK(second.run().steps == 50);
  CHECK((second.state().z - whole.trajectory.state(100).z).lpNorm<Eigen::Infinity>() <= 1e-12);
}

TEST_CASE("a stepper goes to any time and keeps its grid") {
  const auto model = make_model(double_pendulum());
  Stepper stepper(model, dvm_options(5, 0.02, 1.0));
  CHECK(stepper.advance_to(0.3137));
  CHECK(stepper.time() == 0.3137);
  CHECK(stepper.step());
  CHECK(stepper.time() == Approx(0.32).epsilon(1e-15));
  CHECK(stepper.advance_to(7.0));
  CHECK(stepper.time() == 1.0);
  CHECK_FALSE(stepper.step());
  const Simulation whole = simulate(model, dvm_options(5, 0.02, 1.0));
  // One step was divided: the method's error of order 8 in two of its parts.
  CHECK((stepper.state().z - whole.trajectory.state(50).z).lpNorm<Eigen::Infinity>() <= 1e-9);
}

TEST_CASE("a force that is set between steps acts from then on, and its work is in the books") {
  // A mass of 1.7 kg on a line through (2, 1, -2) / 3: what is set pushes it by the share along the line,
  // plus gravity's; parabola after parabola.
  const Vec3 along = Vec3(2, 1, -2) / 3;
  const auto model = build_model(read_scene_text(
      "gravity = {acceleration = [0, 0, -9.81]}\n[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = "
      "'P'\nposition = "
      "[0.2, 0.3, "
      "-0.1]\nmass = 1.7\n[[constraints]]\nkind = 'line'\nnodes = ['P']\ndirection = [2, 1, -2]\n",
      "line.toml"));
  Stepper stepper(model, dvm_options(3, 0.05, 1.0));
  double x = 0, v = 0;
  for (int k = 0; k < 20; ++k) {
    const Vec3 push(3.0 * std::sin(1.3 * k), k < 5 ? 0.0 : 2.5, 0.4 * k);
    stepper.set_force(0, push);
    REQUIRE(stepper.step());
    const double a = along.dot(push) / 1.7 + along.dot(Vec3(0, 0, -9.81));
    x += 0.05 * v + 0.5 * a * 0.05 * 0.05;
    v += 0.05 * a;
    VectorXd q(3);
    stepper.model().system.expand(stepper.state().z, q);
    CHECK((q - Vec3(0.2, 0.3, -0.1) - x * along).norm() < 1e-13);
  }
  const std::size_t states = stepper.run().trajectory.size();
  CHECK(states == 40);  // both sides of each jump but the first
  stepper.set_force(0, Vec3(3.0 * std::sin(1.3 * 19), 2.5, 0.4 * 19));  // as it is
  CHECK(stepper.run().trajectory.size() == states);
  CHECK_THROWS_AS(stepper.set_force(1, Vec3::Zero()), std::out_of_range);
  const Diagnostics books = diagnose(stepper.run());
  for (const double balance : books.at("energy_balance_J").values) CHECK(std::abs(balance) < 1e-12);
  CHECK(std::abs(books.at("work_J").values.back()) > 0.1);
}

// A rod along x that slides along it, pushed at both ends by forces that cancel: nothing moves, the rod is
// pressed by what was set, and there is no state in which only one of the forces has changed.
TEST_CASE("forces that are set at one time act at once") {
  const auto model = build_model(read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'P', position = [0, 0, 0], mass = 1}, {name = 'Q', "
      "position = [1, 0, 0], mass = 1}]\nrods = [{nodes = ['P', 'Q'], mass = 0}]\n[[constraints]]\nkind = "
      "'line'\nnodes = ['P', 'Q']\ndirection = [1, 0, 0]\n",
      "rod.toml"));
  Stepper stepper(model, dvm_options(3, 0.05, 1.0));
  const auto press = [&](double force) {
    stepper.set_force(0, Vec3(force, 0, 0));
    stepper.set_force(1, Vec3(-force, 0, 0));
  };
  press(10);
  for (int k = 0; k < 20; ++k) {
    REQUIRE(stepper.step());
    press(k % 2 ? 10 : -10);
  }
  const Diagnostics d = diagnose(stepper.run());
  REQUIRE(d.axial_force.rows() == 1 + 2 * 20);
  for (Index i = 0; i < d.axial_force.rows(); ++i) {
    const double pressed = i % 4 < 2 ? -10 : 10;  // both sides of each change
    CHECK(d.axial_force(i, 0) == Approx(pressed).epsilon(1e-12));
  }
  CHECK(stepper.state().w.lpNorm<Eigen::Infinity>() <= 1e-12);
}

TEST_CASE("advancing to a time ends where it is told to and can go on") {
  const auto model = make_model(double_pendulum());
  Stepper stepper(model, dvm_options(4, 0.01, 1.0));
  int asked = 0;
  CHECK(stepper.advance_to(0.5, [&] { return ++asked > 20; }));
  CHECK(stepper.time() == Approx(0.2).epsilon(1e-12));
  CHECK(stepper.advance_to(0.5));
  CHECK(stepper.time() == 0.5);
}

TEST_CASE("between its steps a motion is as accurate as at them") {
  // The upright of the ladder turns by up to 1.5 rad in a step: a cubic through the ends is centimetres off.
  const Simulation run = simulate(make_model(ladder_structure(1, 1.0)), dvm_options(7, 0.1, 3.0));
  REQUIRE(run.status == RunStatus::completed);
  double worst_length = 0, worst = 0;
  const Simulation fine = simulate(make_model(ladder_structure(1, 1.0)), dvm_options(7, 0.1 / 8, 3.0));
  for (std::size_t i = 0; i < fine.trajectory.size(); ++i) {
    const double t = fine.trajectory.time(i);
    const VectorXd q = run.trajectory.positions_at(t);
    for (const Rod& rod : run.trajectory.structure().rods)
      worst_length =
          std::max(worst_length,
                   std::abs((q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)).norm() / rod.length - 1));
    worst = std::max(worst, (q - fine.trajectory.positions(i)).lpNorm<Eigen::Infinity>());
    CHECK((run.trajectory.velocities_at(t) - fine.trajectory.velocities(i)).lpNorm<Eigen::Infinity>() <=
          1e-6);
  }
  double at_steps = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    at_steps = std::max(
        at_steps, (run.trajectory.positions(i) - fine.trajectory.positions(8 * i)).lpNorm<Eigen::Infinity>());
  CHECK(worst_length <= 1e-9);
  CHECK(worst <= 3 * at_steps + 1e-11);
}

TEST_CASE("every method's motion is shown to its own accuracy between steps") {
  const auto model = make_model(double_pendulum());
  for (const Method& method : methods()) {
    SolverOptions options = dvm_options(4, 0.05, 1.0);
    options.method = method.name;
    const Simulation run = simulate(model, options);
    const Simulation truth = simulate(model, dvm_options(7, 0.01, 1.0));
    double at = 0, between = 0;
    for (std::size_t i = 0; i < truth.trajectory.size(); ++i) {
      const double off =
          (run.trajectory.positions_at(truth.trajectory.time(i)) - truth.trajectory.positions(i))
              .lpNorm<Eigen::Infinity>();
      (i % 5 == 0 ? at : between) = std::max(i % 5 == 0 ? at : between, off);
    }
    INFO(method.name << ": " << at << " at steps, " << between << " between");
    CHECK(between <= 2 * at + 1e-10);
  }
}

TEST_CASE("what is shown goes through impacts without ringing") {
  const Simulation run = run_scene(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0.2], mass = 2}]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["A"]
direction = [0, 0, 1]
min = 0
restitution = 0.5
[gravity]
acceleration = [0, 0, -10]
[solver]
stages = 4
step = 0.15
end_time = 0.5
)");
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.005 * k;
    const double z = t < 0.2   ? 0.2 - 5 * t * t
                     : t < 0.4 ? (t - 0.2) - 5 * (t - 0.2) * (t - 0.2)
                               : 0.5 * (t - 0.4) - 5 * (t - 0.4) * (t - 0.4);
    CHECK(run.trajectory.positions_at(t)[2] == Approx(z).epsilon(0).margin(1e-10));
  }
}

TEST_CASE(
    "what is pushed on a node is one load of its own, behind those of the scene, however often it changes") {
  Structure structure = double_pendulum();
  structure.loads = {{1, Vec3(1, 2, 3)}};
  auto model = make_model(structure);
  const auto push = [&](int node, const Vec3& force) {
    const auto next = pushed_model(*model, 1, node, force);
    if (next) model = next;
    return next != nullptr;
  };
  CHECK_FALSE(push(2, Vec3::Zero()));  // nothing was pushed there
  CHECK(push(1, Vec3(0.5, 0, 0)));
  CHECK(push(2, Vec3(0, 0.7, 0)));
  CHECK(push(1, Vec3(0, 0, -4)));
  CHECK_FALSE(push(1, Vec3(0, 0, -4)));
  const auto& loads = model->structure.loads;
  REQUIRE(loads.size() == 3);
  CHECK((loads[0].node == 1 && loads[0].force == Vec3(1, 2, 3)));
  CHECK((loads[1].node == 1 && loads[1].force == Vec3(0, 0, -4)));
  CHECK((loads[2].node == 2 && loads[2].force == Vec3(0, 0.7, 0)));
  CHECK_THROWS_AS(push(3, Vec3::Zero()), std::out_of_range);
  CHECK_THROWS_AS(push(-1, Vec3::Zero()), std::out_of_range);
}

}  // namespace stepper_test
