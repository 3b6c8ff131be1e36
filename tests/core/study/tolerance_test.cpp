#include <catch2/catch.hpp>
#include <cmath>

#include "core/study/reference.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

TEST_CASE("the true error is below the tolerance that was asked for") {
  const auto ring = make_model(hoop_structure({{"model", std::string("sector")}}));
  const auto pendulum = make_model(double_pendulum());
  const Reference truth = solve_reference(pendulum, 2.0, 20, {});
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    INFO(tolerance);
    SolverOptions options = dvm_options(3, 0.01, 2.0);
    options.tolerance = tolerance;
    const Simulation swing = simulate_as_asked(pendulum, options);
    CHECK(swing.position_estimate <= tolerance);
    const auto last = swing.trajectory.size() - 1;
    CHECK(node_distance(swing.trajectory.node_positions(last), truth.q.back()) <= tolerance);

    options.end_time = 4.5;
    const Simulation unfolding = simulate_as_asked(ring, options);
    const auto end = unfolding.trajectory.size() - 1;
    const double angle = ring->structure.deployment.fold_angle(unfolding.trajectory.node_positions(end));
    // The hinge moves by up to 2 k l1 = 12 m per rad of the fold angle, none moves faster.
    CHECK(std::abs(angle - exact_hoop().angle(4.5)) <= tolerance);
  }
}

TEST_CASE("a tolerance below round-off is said to be out of reach") {
  SolverOptions options = dvm_options(3, 0.01, 1.0);
  options.tolerance = 1e-18;
  const Simulation run = simulate_as_asked(make_model(double_pendulum()), options);
  CHECK(run.status == RunStatus::completed);
  REQUIRE_FALSE(run.warnings.empty());
  CHECK(run.warnings.back().find("out of reach") != std::string::npos);
}

TEST_CASE("tighter tolerances cost more work, by stages or steps") {
  SolverOptions options = dvm_options(3, 0.01, 2.0);
  const auto model = make_model(double_pendulum());
  options.tolerance = 1e-3;
  const Simulation loose = simulate_as_asked(model, options);
  options.tolerance = 1e-9;
  const Simulation tight = simulate_as_asked(model, options);
  CHECK(loose.newton_iterations < tight.newton_iterations * 2);
  CHECK(tight.position_estimate < loose.position_estimate);
}
