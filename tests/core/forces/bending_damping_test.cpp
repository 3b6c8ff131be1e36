// SPDX-License-Identifier: BSD-3-Clause
// Rods that bend are damped by the law of their material.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace bending_damping_test {

namespace {

constexpr double E = 7e9, A = 1e-4, l = 1.0, m = 0.27;

// A beam of pinned ends, in two parts, pushed aside in its middle for 0.02 s.
std::string pushed(const std::string& damping) {
  return "[structure]\nkind = 'custom'\nyoungs_modulus = 7e9\nrod_model = 'elastic'\nsegments = 2\n" +
         damping + R"(
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 0.1}]
rods = [{nodes = ["A", "B"], mass = 0.27, area = 1e-4, name = "beam"}]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[[constraints]]
kind = "plane"
nodes = ["beam.1"]
normal = [0, 0, 1]
[[forces]]
kind = "load_over_time"
nodes = ["beam.1"]
force = [0, 1e-3, 0]
times = [0, 0.02, 0.02, 1]
values = [1, 1, 0, 0]
[solver]
end_time = 0.32
stages = 4
step = 0.002
)";
}

}  // namespace

// M = E I (kappa + T kappa'): with one node between the ends, on which parts of m / 2 lay 2 (m / 2) / 3, and
// V = (E I / 2 L) (4 y / l)^2, L = l / 2,
//
//     y'' + T w^2 y' + w^2 y = 0,     w^2 = 96 E I / (m l^3) = 44.4^2 1/s^2
//
// Deflections of 1e-6 m, of which the square is the error of the linear equation; w h = 0.09, sixth order.
TEST_CASE("bending: the middle of a pinned beam dies away as the damping time of its material says") {
  const double EI = E * A * A / (4 * pi), w = std::sqrt(96 * EI / (m * l * l * l));
  const double axial = std::sqrt(12 * E * A / l / m) / 2;  // in two parts: 1 - cos(pi / 2) = 1
  for (const bool by_ratio : {false, true}) {
    // The ratio is of stretching: T = 2 ratio / w_axial, w_axial^2 = 6 n^2 (1 - c) / (2 + c) k / m = 12 k /
    // m.
    const double T = 0.01, ratio = T * 2 * axial / 2;
    const Simulation run = testing::run_scene(
        pushed(by_ratio ? "damping_ratio = " + std::to_string(ratio) : "damping_time = 0.01"));
    REQUIRE(run.status == RunStatus::completed);
    const double decay = T * w * w / 2, turn = std::sqrt(w * w - decay * decay);
    const double rest = 1e-3 / (m / 3) / (w * w);  // where the push holds it
    const auto step = [&](double t) {              // of the push, from t = 0 on
      if (t < 0) return 0.0;
      return rest * (1 - std::exp(-decay * t) * (std::cos(turn * t) + decay / turn * std::sin(turn * t)));
    };
    double off = 0, after = 0;
    for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
      const double t = run.trajectory.time(i), y = run.trajectory.node_positions(i)[7];
      off = std::max(off, std::abs(y - (step(t) - step(t - 0.02))));
      if (t > 0.28) after = std::max(after, std::abs(y));
    }
    INFO("by_ratio " << by_ratio << ", off " << off << " of " << rest << ", after " << after);
    CHECK(off < 1e-5 * rest);
    CHECK(after < 0.2 * rest);  // exp(-decay 0.26) = 0.08
    const Diagnostics d = diagnose(run);
    const double taken = d.at("dissipated_J").values.back();
    // What the push put in is gone but for exp(-2 decay 0.3) of it; the balance closes.
    CHECK(taken == Approx(d.at("work_J").values.back()).epsilon(0.02));
    CHECK(testing::largest(d, "energy_balance_J") < 1e-9 * taken);
  }
}

}  // namespace bending_damping_test
