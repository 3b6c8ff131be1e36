// SPDX-License-Identifier: BSD-3-Clause
// The table of extremes: each ends in a right answer or in a declared stop with its reason, never in silent
// nonsense.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/integrators/integrator.hpp"
#include "core/structures/custom.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace extremes_test {

namespace {

struct Outcome {
  RunStatus status;
  std::string message;
  VectorXd q;             // at the end [m]
  double constraint = 0;  // largest |l - l_0| / l_0 over the run
  double energy = 0;      // largest |E - E_0 - work| over the run, of the largest energy that moved
  bool finite = true;
};

Outcome outcome(const Structure& structure, const SolverOptions& options) {
  const auto model = make_model(structure);
  const Simulation run = simulate(model, options);
  Outcome out{run.status, run.message, run.trajectory.node_positions(run.trajectory.size() - 1)};
  double start = 0, moved = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const VectorXd q = run.trajectory.node_positions(i);
    const State& s = run.trajectory.state(i);
    const double kinetic = model->system.kinetic_energy(s.w);
    const double energy = kinetic + model->system.potential_energy(q) - model->system.load_work(q);
    if (i == 0) start = energy;
    moved = std::max(moved, kinetic);
    out.energy = std::max(out.energy, std::abs(energy - start));
    out.finite = out.finite && q.allFinite() && s.w.allFinite() && s.lambda.allFinite();
    for (const Rod& rod : structure.rods)
      out.constraint =
          std::max(out.constraint,
                   std::abs((q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)).norm() / rod.length - 1));
  }
  out.energy /= std::max(moved, 1e-300);
  return out;
}

// What no run may do, whatever its end: keep states that are not numbers or whose rods have changed length;
// end early without saying why.
void check_sound(const Outcome& out) {
  INFO(to_string(out.status) << ": " << out.message);
  CHECK(out.finite);
  CHECK(out.constraint <= 1e-12);
  CHECK((out.status == RunStatus::failed) == !out.message.empty());
}

Structure pendulum(double tip_mass, const Vec3& gravity, double rod_mass = 1.0) {
  CustomSpec spec;
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true},
                {"A", {1, 0, 0}, {0, 0, 0}, 0.0, false},
                {"B", {2, 0, 0}, {0, 0, 0}, tip_mass, false}};
  spec.rods = {{"OA", {"O", "A"}, rod_mass}, {"AB", {"A", "B"}, 1.0}};
  Structure structure = build_custom(spec);
  structure.gravity = gravity;
  return structure;
}

}  // namespace

TEST_CASE("extremes: rods that repeat others change nothing") {
  Structure ladder = ladder_structure(2, 3.0), repeated = ladder;
  for (int copy = 0; copy < 2; ++copy)
    for (std::size_t i = 0; i < ladder.rods.size(); ++i) {
      Rod rod = ladder.rods[i];
      rod.name += " again " + std::to_string(copy);
      rod.mass = 0.0;
      repeated.rods.push_back(rod);
    }
  show_as_solved(repeated);
  const Outcome out = outcome(repeated, dvm_options(4, 0.01, 3.0));
  check_sound(out);
  REQUIRE(out.status == RunStatus::completed);
  const double phi = exact::FourBarLadder{2, 3.0}.angle(3.0);
  // Order 6 at 3 rad/s and h = 0.01 s leaves (0.03)^6 = 1e-9 of a radian a turn; a hundredfold.
  CHECK((out.q.segment<3>(3) - Vec3(std::sin(phi), std::cos(phi), 0)).norm() <= 1e-7);
}

TEST_CASE("extremes: a start exactly at a singular pose") {
  // All rods of the ladder along x, and released so: the tops move down with one speed, a ladder turned to 90
  // deg.
  Structure ladder = ladder_structure(2, 0.0);
  for (int i = 0; i <= 2; ++i) {
    ladder.nodes[static_cast<std::size_t>(2 * i + 1)].position = {i + 1.0, 0, 0};
    ladder.nodes[static_cast<std::size_t>(2 * i + 1)].velocity = {0, -3.0, 0};
  }
  show_as_solved(ladder);
  const Outcome out = outcome(ladder, dvm_options(4, 0.01, 1.0));
  check_sound(out);
  // Where it comes through, it is as a ladder that keeps its energy; either branch is a motion of the
  // mechanism.
  if (out.status == RunStatus::completed) CHECK(out.energy <= 1e-6);
}

TEST_CASE("extremes: the fully deployed ring, pushed on") {
  // As near to it as a hoop may start: 1.7e-9 rad.
  const Outcome out = outcome(hoop_structure({{"fold_angle", 1e-7}}), dvm_options(3, 0.01, 1.0));
  check_sound(out);
}

TEST_CASE("extremes: dead centre") {
  // 1e-9 deg from it the deployment takes long, as exactly as elsewhere.
  const Structure hoop = hoop_structure({{"fold_angle", 90.0 - 1e-9}});
  const Outcome out = outcome(hoop, dvm_options(4, 0.02, 60.0));
  check_sound(out);
  CHECK((out.status == RunStatus::deployed || out.status == RunStatus::failed));
}

TEST_CASE("extremes: steps of half a second") {
  for (const auto& structure : {double_pendulum(), ladder_structure(2, 1.0), hoop_structure()}) {
    const Outcome out = outcome(structure, dvm_options(4, 0.5, 10.0));
    INFO(structure.kind);
    check_sound(out);
  }
}

TEST_CASE("extremes: masses that differ by 1e8 either way") {
  for (const auto& [tip, rod] :
       {std::pair{1e8, 1.0}, std::pair{1e-8, 1.0}, std::pair{0.0, 1e8}, std::pair{0.0, 1e-8}}) {
    const Outcome out = outcome(pendulum(tip, {0, 0, -9.81}, rod), dvm_options(4, 0.005, 1.0));
    INFO("tip " << tip << " kg, rod " << rod << " kg: energy " << out.energy);
    check_sound(out);
    // The energy of a converged run at this step is right to the method's order.
    if (out.status == RunStatus::completed) CHECK(out.energy <= 1e-5);
  }
}

TEST_CASE("extremes: forces of 1e9 N") {
  for (const double force : {1e9, -1e9}) {
    Structure structure = double_pendulum();
    structure.loads.push_back({2, {0, 0, force}, true});
    show_as_solved(structure);
    // 1e9 N on some kg swing at 1e4 rad/s and more: too fast for the first step, resolved by the second.
    for (const double h : {0.01, 1e-6}) {
      const Outcome out = outcome(structure, dvm_options(4, h, 200 * h));
      INFO("h = " << h << ": energy " << out.energy);
      check_sound(out);
      if (h < 1e-5) {
        CHECK(out.status == RunStatus::completed);
        CHECK(out.energy <= 1e-6);
      }
    }
  }
}

TEST_CASE("extremes: what overflows fails with a reason, by every method") {
  for (const Method& method : methods())
    for (const double g : {1e306, 1e200}) {
      SolverOptions options = dvm_options(3, 0.01, 0.1);
      options.method = method.name;
      const Outcome out = outcome(pendulum(1.0, {0, 0, -g}), options);
      INFO(method.name << ", g = " << g << ": " << to_string(out.status) << " " << out.message);
      CHECK(out.status == RunStatus::failed);
      CHECK_FALSE(out.message.empty());
      CHECK(out.finite);
    }
}

TEST_CASE("extremes: many steps keep rods and energy") {
  // 2 x 10^4 steps here; a million: `unfurl run ladder --set solver.step=1e-4 --set solver.end_time=100 -o
  // DIR`
  SolverOptions options = dvm_options(3, 1e-4, 2.0);
  const Outcome out = outcome(ladder_structure(1, 3.0), options);
  check_sound(out);
  REQUIRE(out.status == RunStatus::completed);
  const double phi = exact::FourBarLadder{1, 3.0}.angle(2.0);
  CHECK((out.q.segment<3>(3) - Vec3(std::sin(phi), std::cos(phi), 0)).norm() <= 1e-8);
  CHECK(out.energy <= 1e-9);
}

}  // namespace extremes_test
