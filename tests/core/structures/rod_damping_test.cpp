// SPDX-License-Identifier: BSD-3-Clause
// damping_ratio: of critical damping, where a rod is free and alone.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/vibration.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace rod_damping_test {

namespace {

constexpr double E = 7e10, A = 1e-4, l = 2, m = 0.54, speed = 0.01;

// A rod of 2 m whose ends are flung apart.
std::string free_rod(const std::string& more) {
  return "[structure]\nkind = 'custom'\nyoungs_modulus = 7e10\nrod_model = 'elastic'\n" + more + R"(
nodes = [{name = "A", position = [0, 0, 0], velocity = [-0.01, 0, 0]},
         {name = "B", position = [2, 0, 0], velocity = [0.01, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 0.54, area = 1e-4}]
[solver]
step = 1e-5
stages = 4
end_time = 2e-3
)";
}

}  // namespace

// One element stretches by e'' + 2 z w e' + w^2 e = 0, w^2 = 12 k / m, of a lumped mass 4 k / m: critically
// damped e = 2 v t exp(-w t). Steps of 1/20 of 1/w or less and order 6: 1e-7 of the largest.
TEST_CASE("a rod of critical damping, flung apart, comes to rest without coming back") {
  for (const bool lumped : {false, true}) {
    const Simulation run = testing::run_scene(
        free_rod(std::string("damping_ratio = 1.0\nmass = '") + (lumped ? "lumped" : "consistent") + "'\n"));
    REQUIRE(run.status == RunStatus::completed);
    const double w = std::sqrt((lumped ? 4 : 12) * E * A / l / m), most = 2 * speed / w * std::exp(-1);
    INFO(lumped);
    for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
      const VectorXd q = run.trajectory.node_positions(i);
      const double t = run.trajectory.time(i), e = 2 * speed * t * std::exp(-w * t);
      CHECK(std::abs(q[3] - q[0] - l - e) < 1e-6 * most);
    }
  }
}

// Of a rod in parts, the first way in which it stretches, as its undamped modes have it: T = 2 z / w.
TEST_CASE("the damping of a rod in parts is that of its slowest stretching") {
  for (const char* mass : {"lumped", "consistent"})
    for (const char* segments : {"1", "2", "5"}) {
      const auto model = testing::model_of(
          free_rod(std::string("damping_ratio = 0.3\nmass = '") + mass + "'\nsegments = " + segments + "\n"));
      const Vibration v = vibration(*model, initial_state(model->structure, model->system).state);
      INFO(mass << ", " << segments);
      // Frequencies of modes of elastic rods are right to round-off; the mode along x is the lowest of them.
      double lowest = std::numeric_limits<double>::infinity();
      for (const VibrationMode& mode : v.modes) {
        double along = 0;
        for (Index i = 0; i < mode.shape.size(); i += 3) along = std::max(along, std::abs(mode.shape[i]));
        if (!mode.mechanism && along > 0.5) lowest = std::min(lowest, mode.frequency);
      }
      const double w = 2 * pi * lowest;
      for (const Rod& rod : model->structure.rods)
        CHECK(rod.damping_time == Approx(2 * 0.3 / w).epsilon(1e-9));
    }
}

}  // namespace rod_damping_test
