// SPDX-License-Identifier: BSD-3-Clause
// What a run says that it is off by, beside what it is off by.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/structure/node_positions.hpp"
#include "core/study/reference.hpp"
#include "core/study/tolerance.hpp"
#include "tests/support/models.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace estimate_test {

namespace {

// 2 kg on a spring of 1 m and 180 N/m, let go at 1.3 m with 0.7 m/s: x = 1 + 0.3 cos w t + 0.7/w sin w t.
const std::string swing = R"(
[structure]
kind = "custom"
nodes = [{name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1.3, 0, 0], velocity = [0.7, 0, 0], mass = 2}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 180
free_length = 1
[solver]
end_time = 1.7
)";

double off(const Simulation& run) {
  const double w = std::sqrt(90.0);
  double most = 0;
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    const double t = run.trajectory.time(i);
    most = std::max(most, std::abs(run.trajectory.node_positions(i)[3] - 1 - 0.3 * std::cos(w * t) -
                                   0.7 / w * std::sin(w * t)));
  }
  return most;
}

}  // namespace

// The second solution, against which a run is judged, has a stage more or, without stages, 12/5 as many
// steps, which leave (5/12)^p of an error of order p; what damps is judged by dvm.
TEST_CASE("an estimated error is the largest that the run has at any of its times") {
  struct Case {
    const char* method;
    double share, known;
  };
  for (const Case& c : {Case{"dvm", 1, 1e-3},
                        {"rk4", 1 - std::pow(5.0 / 12, 4), 3e-3},
                        {"rk4_projected", 1 - std::pow(5.0 / 12, 4), 3e-3},
                        {"generalized_alpha", 1, 1e-3}})
    for (const char* tolerance : {"1e-2", "1e-4", "1e-6"}) {
      const Scene scene =
          read_scene_text(swing, "s.toml",
                          {"solver.method=\"" + std::string(c.method) + "\"", "solver.model=\"full\"",
                           "solver.tolerance=" + std::string(tolerance)});
      const Simulation run = simulate_as_asked(build_model(scene), scene.solver);
      INFO(c.method << " " << tolerance << ", " << run.trajectory.size() << " states");
      CHECK(run.position_estimate == Approx(c.share * off(run)).epsilon(c.known));
      // Half of what was asked for at most; a fiftieth at least, or there are no fewer steps.
      CHECK(run.position_estimate <= 0.5 * scene.solver.tolerance);
      CHECK((run.position_estimate >= 0.02 * scene.solver.tolerance || run.trajectory.size() == 36));
      CHECK((run.trajectory.size() - 1) % 35 == 0);
      CHECK(run.options.tolerance == scene.solver.tolerance);
      CHECK(run.warnings.empty());
    }
}

// A ring that unfolds by its exact law, whose error a run has where it stops, too: there by the time, as a
// way.
TEST_CASE("an estimated error of a ring that deploys is that of its nodes on their way") {
  for (const char* method : {"dvm", "rk4"}) {
    INFO(method);
    SolverOptions options = dvm_options(3, 0.01, 6.0);
    options.method = method;
    options.model = "full";
    options.at_deployed = "stop";
    options.tolerance = 1e-3;
    const auto ring = [](double fold_angle) {
      return hoop_structure({{"model", std::string("sector")}, {"fold_angle", fold_angle}});
    };
    const Simulation run =
        simulate_as_asked(make_model(hoop_structure({{"model", std::string("sector")}})), options);
    REQUIRE(run.status == RunStatus::deployed);
    const std::size_t last = run.trajectory.size() - 1;
    double most = 0;
    for (std::size_t i = 0; i < last; ++i) {
      const VectorXd there =
          node_positions(ring(exact_hoop().angle(run.trajectory.time(i)) / radians_per_degree));
      most = std::max(most, node_distance(there, run.trajectory.node_positions(i)));
    }
    // The other solution keeps (5/12)^4, 3 %, of it.
    CHECK(run.position_estimate == Approx(most).epsilon(0.04));
    CHECK(most > 1e-6);
    const VectorXd v = run.trajectory.node_velocities(last);
    const double fastest = node_distance(v, VectorXd::Zero(v.size()));
    CHECK(fastest * std::abs(run.trajectory.end_time() - exact_hoop().time(0.0)) <= run.position_estimate);
  }
}

}  // namespace estimate_test
