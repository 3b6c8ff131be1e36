// SPDX-License-Identifier: BSD-3-Clause
// Our variational method against an independent solver of an independent form of the equations.
#include <catch2/catch.hpp>

#include "core/simulate/initial_state.hpp"
#include "tests/support/four_bar_exact.hpp"
#include "tests/support/ida_reference.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace {

// Largest difference of node coordinates over a run [m].
double apart(const Structure& structure, int stages, double end, const IdaOptions& options) {
  const auto model = make_model(structure);
  const Simulation ours = simulate(model, dvm_options(stages, 0.01, end));
  REQUIRE(ours.status == RunStatus::completed);
  std::vector<double> times;
  for (std::size_t i = 1; i < ours.trajectory.size(); ++i) times.push_back(ours.trajectory.time(i));
  const IdaRun ida =
      solve_with_ida(model->system, initial_state(structure, model->system).state, times, options);
  INFO("IDA: " << ida.message << ", " << ida.steps << " steps, " << ida.cpu_s << " s");
  REQUIRE(ida.ok);
  double worst = 0;
  VectorXd q(model->system.coordinates());
  for (std::size_t i = 0; i < times.size(); ++i) {
    model->system.expand(ida.states[i].z, q);
    worst = std::max(worst, (q - ours.trajectory.node_positions(i + 1)).lpNorm<Eigen::Infinity>());
  }
  return worst;
}

}  // namespace

TEST_CASE("reference: IDA agrees on the double pendulum") {
  // A variable-step solver's error is some hundred times its tolerance after a second of swinging; four
  // stages leave 1e-10.
  CHECK(apart(double_pendulum(), 4, 1.0, {1e-10, 1e-12}) <= 1e-7);
}

TEST_CASE("reference: IDA agrees on the six-unit ring, redundant rows and all") {
  // To 4 s of 4.92: rtol 1e-10 leaves at most 4e-7 m, four stages 1e-9.
  CHECK(apart(hoop_structure(), 4, 4.0, {1e-10, 1e-12}) <= 4e-7);
}

TEST_CASE("reference: IDA agrees on the ladder before its first collinear pose") {
  // Upright to 80 deg at 3 m/s takes 0.4 s.
  const exact::FourBarLadder ladder{2, 3.0};
  REQUIRE(ladder.angle(0.35) < 0.45 * M_PI);
  CHECK(apart(ladder_structure(2, 3.0), 4, 0.35, {1e-10, 1e-12}) <= 1e-8);
}
