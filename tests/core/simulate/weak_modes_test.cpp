// SPDX-License-Identifier: BSD-3-Clause
// Rings that start next to their dead centre, where the chords are upright but for an angle e_0: what holds
// the corners apart are constraints whose gradients are of the order of e_0, and the motion is of that size,
// too. tests/bench/weak_modes_bench.cpp prints the whole table of starts, models, stages and steps.
#include <catch2/catch.hpp>

#include "core/diagnostics/accuracy.hpp"
#include "core/integrators/integrator.hpp"
#include "core/structures/hoop_joints.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace weak_modes_test {

namespace {

struct Setting {
  const char* model;
  double fold_angle;
  int stages;
  double step;
  const char* method = "dvm";
  bool eliminate_linear = true;
};

double error_of_deployment_time(const Setting& s) {
  SolverOptions options = dvm_options(s.stages, s.step, 30);
  options.method = s.method;
  options.eliminate_linear = s.eliminate_linear;
  const Structure ring = hoop_structure({{"model", std::string(s.model)}, {"fold_angle", s.fold_angle}});
  const Simulation run = simulate(make_model(ring, s.eliminate_linear), options);
  INFO(s.model << " " << s.fold_angle << " deg, " << s.method << ", " << s.stages << " stages, step "
               << s.step << ": " << run.message);
  REQUIRE(run.status == RunStatus::deployed);
  return std::abs(run.events[0].t - exact_hoop({{"fold_angle", s.fold_angle}}).time(0));
}

}  // namespace

TEST_CASE("rings next to their dead centre deploy at the right time, no worse with smaller steps") {
  // Truncation leaves 3e-10 s at the largest step, in the quick last second. Round-off of the start, 1e-16 of
  // coordinates of some metres, is amplified by exp(t / 0.95 s) like the motion itself.
  for (const char* model : {"full", "sector"}) {
    CHECK(error_of_deployment_time({model, 80.3, 4, 0.02}) <= 1e-8);
    for (const auto& [stages, step] : {std::pair{4, 0.1}, {4, 0.02}, {6, 0.05}})
      CHECK(error_of_deployment_time({model, 89.9999, stages, step}) <= 1e-8);
    for (const auto& [stages, step] : {std::pair{4, 0.1}, {5, 0.02}})
      CHECK(error_of_deployment_time({model, 89.9999999, stages, step}) <= 1e-7);
  }
  CHECK(error_of_deployment_time({"sector", 89.9999, 5, 0.005}) <= 1e-8);
  CHECK(error_of_deployment_time({"full", 89.9999, 4, 0.1, "dvm", false}) <= 1e-8);
}

TEST_CASE("round-off of a step's coefficients does not add up from step to step") {
  // By the rounding of the start alone, 2e-16 m over the 0.0115 rad that the chords lean, 2e-14 rad grow to
  // 3e-12 m or 1e-12 rad as the angle does, 136 times. 1568 steps of 8 stages, whose kinetic coefficients are
  // some 50, must not bring more: 1e-15 of the momentum in each would be 1e-11 rad.
  for (const int stages : {7, 8}) {
    const auto model = make_model(hoop_structure({{"model", std::string("sector")}}));
    const Simulation run = simulate(model, dvm_options(stages, 4.9 / 1568, 4.9));
    REQUIRE(run.status == RunStatus::completed);
    const VectorXd q = run.trajectory.node_positions(run.trajectory.size() - 1);
    CHECK(std::abs(model->structure.deployment.fold_angle(q) - exact_hoop().angle(4.9)) < 1e-12);
  }
}

TEST_CASE("steps of a folded ring of a thousand units take few iterations") {
  // An iteration leaves half of its weakest modes, e over the square of their singular value: 27 a step. From
  // combinations of the last ones ten are enough, as they are in a ring of a hundred.
  const auto model = make_model(hoop_structure({{"units", 1000L}, {"mass", std::string("consistent")}}));
  const Simulation run = simulate(model, dvm_options(3, 0.01, 0.05));
  REQUIRE(run.status == RunStatus::completed);
  for (std::size_t i = 1; i < run.trajectory.size(); ++i)
    CHECK(run.trajectory.report(i).newton_iterations <= 12);
}

TEST_CASE("explicit methods are right next to a dead centre, too") {
  // Order four: 2e-9 s at 0.003 s by the ladder of steps, 1e-7 s at three times as much.
  for (const char* method : {"rk4", "rk4_projected"})
    CHECK(error_of_deployment_time({"full", 89.9999999, 3, 0.01, method}) <= 1e-6);
}

// With chords nearly upright the corners P_k of a ring with pin joints move in plan by the linear equations
// of
//     T = 1/2 sum_k [m2 |P_k'|^2 + (2 m1/3) (|P_k'|^2 + |P_{k+1}'|^2 + |P_k' + P_{k+1}'|^2)],
//     V = -(f / 4 l1) sum_k |P_{k+1} - P_k|^2
// (hinges over the middles of the sides). The shape P_k = exp(2 pi i j k / n) grows at the rate omega_j with
//     omega_j^2 = (f / 2 l1) (2 - 2 c) / [m2 + (2 m1/3) (4 + 2 c)],   c = cos(2 pi j / n)
// j = 1 is the even deployment; the uneven ones grow faster. Nothing but round-off is there to begin them.
double growth_rate(const exact::Hoop& h, int j) {
  const double c = std::cos(2 * pi * j / h.n), m1 = h.density * h.area * h.l1, m2 = h.density * h.area * h.l2;
  return std::sqrt(h.f / (2 * h.l1) * (2 - 2 * c) / (m2 + 2 * m1 / 3 * (4 + 2 * c)));
}

TEST_CASE("a ring with pin joints deploys unevenly from round-off at the rate of its fastest uneven mode") {
  const exact::Hoop exact = exact_hoop({{"fold_angle", 89.9999}});
  const Simulation run =
      simulate(make_model(hoop_structure({{"model", std::string("joints")}, {"fold_angle", 89.9999}})),
               dvm_options(4, 0.05, 9));
  const auto spread = [&](double time) {  // of the sides, relative
    const VectorXd q = run.trajectory.node_positions(static_cast<std::size_t>(std::lround(time / 0.05)));
    double least = 1e9, most = 0;
    for (Index k = 0; k < 6; ++k) {
      const double side = (q.segment<2>(12 * ((k + 1) % 6)) - q.segment<2>(12 * k)).norm();
      least = std::min(least, side);
      most = std::max(most, side);
    }
    return (most - least) / most;
  };
  REQUIRE(run.status == RunStatus::completed);
  const double rate = growth_rate(exact, 3) - growth_rate(exact, 1);
  // The fastest mode is alone after a few seconds.
  CHECK(std::log(spread(9) / spread(5)) == Approx(4 * rate).epsilon(0.03));
  // It begins at some ulp of the sides.
  CHECK(spread(5) <= 1e-14 * std::exp(5 * rate));
}

TEST_CASE("a ring with pin joints deploys at the right time while its uneven modes have no time to grow") {
  CHECK(error_of_deployment_time({"joints", 80.3, 4, 0.02}) <= 1e-8);
  CHECK(error_of_deployment_time({"joints", 89.3, 4, 0.02}) <= 1e-8);
  // Shifts of the hinges grow by exp(4.3 t) against exp(1.05 t) of the motion: for 8.9 s by 4e12 at 89.99
  // deg. An ulp of the start is 4e-4 of the motion then, and its square enters the time.
  CHECK(error_of_deployment_time({"joints", 89.95, 6, 0.05}) <= 1e-8);
  CHECK(error_of_deployment_time({"joints", 89.99, 5, 0.02}) <= 1e-8);
}

TEST_CASE("a ring with pin joints that round-off has made uneven is not taken for deployed") {
  const auto judged = [](std::initializer_list<std::pair<const char*, ParamValue>> changes) {
    Simulation run = simulate(make_model(hoop_structure(changes)), dvm_options(4, 0.05, 20));
    CHECK(run.status == RunStatus::deployed);
    judge(run);
    return run;
  };
  // 1 s early; by then 4e18 as above.
  const Simulation run = judged({{"model", std::string("joints")}, {"fold_angle", 89.9999}});
  CHECK(run.status == RunStatus::failed);
  CHECK_THAT(run.message, Catch::Contains("round-off has grown to 0.1 %"));
  CHECK(run.events.empty());
  // What is kept is right to the square of a thousandth.
  const std::size_t last = run.trajectory.size() - 1;
  CHECK(run.trajectory.time(last) > 9);
  const double angle = run.trajectory.structure().deployment.fold_angle(run.trajectory.node_positions(last));
  CHECK(std::abs(angle - exact_hoop({{"fold_angle", 89.9999}}).angle(run.trajectory.time(last))) < 1e-5);
  // Twelve units from 89.34 deg are as far gone; one that is asked to be uneven may be; the full model is
  // even.
  CHECK(judged({{"model", std::string("joints")}, {"units", 12L}}).status == RunStatus::failed);
  const Simulation asked = judged({{"model", std::string("joints")},
                                   {"fold_angle", 70.0},
                                   {"perturbed_unit", 2L},
                                   {"perturbed_force", 190.0}});
  CHECK(asked.status == RunStatus::deployed);
  CHECK(unevenness(asked.trajectory.structure(),
                   asked.trajectory.node_positions(asked.trajectory.size() - 1)) > 1e-2);
  CHECK(judged({{"fold_angle", 89.9999}}).status == RunStatus::deployed);
}

TEST_CASE("lengths stay at round-off over long times next to a dead centre", "[.][long]") {
  // A force so small that 1e5 steps of 0.5 s do not leave the neighbourhood of the dead centre.
  const Structure ring = hoop_structure({{"fold_angle", 89.9999}, {"hinge_force", 2e-7}});
  const auto model = make_model(ring);
  const Simulation run = simulate(model, dvm_options(3, 0.5, 5e4));
  REQUIRE(run.status == RunStatus::completed);
  CHECK(run.trajectory.report(run.trajectory.size() - 1).constraint_norm <= 1e-14);
}

}  // namespace weak_modes_test
