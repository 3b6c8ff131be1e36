// SPDX-License-Identifier: BSD-3-Clause
// Steps that are large for the motion: what they cost in iterations, and that they lose nothing.
#include <catch2/catch.hpp>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/step_control.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;

namespace large_steps_test {

TEST_CASE("the ring opens in 17 steps of seven stages, slow modes of its redundant rows extrapolated") {
  constexpr double end = 4.9;  // [s], 20 ms before it is deployed
  const auto model = testing::make_model(testing::hoop_structure());
  SolverOptions options;
  options.stages = 7;
  options.step = 0.8;
  options.adaptive = true;
  options.turn = 0.2;
  const auto method = find_method("dvm")->make(model->system, options);
  StepControl control(model->structure, model->system, options);
  State state = initial_state(model->structure, model->system).state;
  int steps = 0, iterations = 0;
  while (state.t < end) {
    const StepReport report = method->step(state, std::min(control.next(state), end - state.t));
    REQUIRE(report.ok());
    ++steps;
    iterations += report.newton_iterations;
  }
  CHECK(steps <= 17);
  // 167. In 15 steps of other lengths it was 156, without the extrapolation 183.
  CHECK(iterations <= 170);

  const double angle = testing::exact_hoop().angle(end) * 180 / M_PI;
  const Structure there = testing::hoop_structure({{"fold_angle", angle}});
  VectorXd q(model->system.coordinates());
  model->system.expand(state.z, q);
  double off = 0;
  for (std::size_t i = 0; i < there.nodes.size(); ++i)
    off = std::max(off, (q.segment<3>(3 * static_cast<Index>(i)) - there.nodes[i].position).norm());
  // Order 12 in steps that turn by 0.2 rad: 0.2^12 = 4e-9 of 3 m, and an error constant that is far below
  // 0.1.
  CHECK(off < 1e-9);
}

}  // namespace large_steps_test
