// SPDX-License-Identifier: BSD-3-Clause
// Observed orders of convergence on a rod double pendulum in space.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/integrators/integrator.hpp"
#include "tests/support/bennett_loops.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace order_test {

namespace {

VectorXd end_position(SolverOptions options, double h) {
  options.step = h;
  const Simulation run = simulate(make_model(double_pendulum()), options);
  REQUIRE(run.status == RunStatus::completed);
  return run.trajectory.positions(run.trajectory.size() - 1);
}

// Slope of log(error) between two steps, the reference far below both.
double observed_order(const SolverOptions& options, double coarse, const VectorXd& reference) {
  const double e1 = (end_position(options, coarse) - reference).norm();
  const double e2 = (end_position(options, coarse / 2) - reference).norm();
  return std::log2(e1 / e2);
}

}  // namespace

TEST_CASE("orders of the variational methods and of Runge-Kutta") {
  // Reference: 7 stages (order 12) at h = 0.01; halving the step moves it by round-off only, which is checked
  // first.
  const VectorXd reference = end_position(dvm_options(7, 0.01, 1.0), 0.01);
  REQUIRE((end_position(dvm_options(7, 0.01, 1.0), 0.005) - reference).norm() <= 1e-12);
  struct Case {
    const char *method, *nodes, *at;
    int stages;
    double coarse, order;
  };
  // Orders of physics: Lobatto 2 s - 2; other nodes 2, 4, 4, 6 and no more, 4 and 6 for even and odd s, by
  // multipliers; constraints at the ends: 2 whatever s.
  const Case cases[] = {
      {"dvm", "lobatto", "nodes", 2, 0.01, 2},      {"dvm", "lobatto", "nodes", 3, 0.02, 4},
      {"dvm", "lobatto", "nodes", 4, 0.05, 6},      {"dvm", "lobatto", "nodes", 5, 0.05, 8},
      {"dvm", "equidistant", "nodes", 3, 0.02, 4},  {"dvm", "equidistant", "nodes", 4, 0.02, 4},
      {"dvm", "equidistant", "nodes", 5, 0.05, 6},  {"dvm", "chebyshev", "nodes", 4, 0.02, 4},
      {"dvm", "equidistant", "nodes", 6, 0.05, 4},  {"dvm", "equidistant", "nodes", 7, 0.025, 6},
      {"dvm", "equidistant", "nodes", 8, 0.025, 4}, {"dvm", "chebyshev", "nodes", 6, 0.025, 4},
      {"dvm", "chebyshev", "nodes", 7, 0.025, 6},   {"dvm", "chebyshev", "nodes", 8, 0.025, 4},
      {"dvm", "lobatto", "nodes", 6, 0.1, 10},      {"dvm", "equidistant", "ends", 2, 0.01, 2},
      {"dvm", "equidistant", "ends", 3, 0.01, 2},   {"dvm", "equidistant", "ends", 5, 0.01, 2},
      {"rk4", "lobatto", "nodes", 2, 0.01, 4},
  };
  for (const Case& c : cases) {
    SolverOptions options = dvm_options(c.stages, c.coarse, 1.0);
    options.method = c.method;
    options.nodes = c.nodes;
    options.constraints_at = c.at;
    INFO(c.method << " " << c.nodes << " " << c.at << " s = " << c.stages);
    // Asymptotics set in late for high orders; a wrong scheme is off by a whole order or two.
    CHECK(observed_order(options, c.coarse, reference) == Approx(c.order).epsilon(0).margin(0.45));
    CHECK(find_method(c.method)->claims(options).order == c.order);
  }
}

TEST_CASE("between the step ends the paper's scheme flies free: more stages change nothing") {
  SolverOptions options = dvm_options(2, 0.01, 1.0);
  options.constraints_at = "ends";
  options.nodes = "equidistant";
  const VectorXd two = end_position(options, 0.01);
  for (int s : {3, 5, 8}) {
    options.stages = s;
    // Constant force: the same trajectory to all digits, up to 100 steps of round-off.
    CHECK((end_position(options, 0.01) - two).norm() <= 1e-11);
  }
}

// In Bennett's loop two rods more than hold it contradict each other wherever an iteration stands; left in
// the multipliers that had steps of 0.01 s end up to 7e-6 m aside, by no order.
TEST_CASE("constraints at the ends of steps: redundant rods change neither that nor the order") {
  const auto off = [](const std::string& step, const std::string& stages, const VectorXd& from) {
    const Simulation run =
        run_scene(bennett_loops(0, 1, 0.0),
                  {"solver.constraints_at=ends", "solver.step=" + step, "solver.stages=" + stages});
    REQUIRE(run.status == RunStatus::completed);
    return VectorXd(end_positions(run) - from);
  };
  const Simulation exact = run_scene(bennett_loops(0, 1, 0.0));  // to 1e-12 m
  REQUIRE(exact.status == RunStatus::completed);
  const VectorXd reference = end_positions(exact), two = off("0.01", "2", reference);
  CHECK(off("0.02", "2", reference).norm() / two.norm() == Approx(4).epsilon(0.02));
  for (const std::string stages : {"3", "4", "6"}) {
    INFO(stages);
    // Round-off of 70 steps, as above.
    CHECK((off("0.01", stages, reference) - two).norm() <= 1e-11);
    CHECK((off("0.02", stages, reference) - off("0.02", "2", reference)).norm() <= 1e-11);
  }
}

}  // namespace order_test
