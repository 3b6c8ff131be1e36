// SPDX-License-Identifier: BSD-3-Clause
// The first of adaptive steps, by the formulas of step_control.hpp spelt out for one rod.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/simulate/initial_state.hpp"
#include "core/simulate/step_control.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace first_step_test {

namespace {

constexpr double length = 1.3, g = 9.81, longest = 0.17, turn = 0.23;

// A uniform rod about its end in the plane y = 0; its other end moves as a mass under 3/2 g.
struct Rod {
  Eigen::Vector2d x, v;
  double gravity = 0;

  Eigen::Vector2d acceleration() const {
    const Eigen::Vector2d free(0, -1.5 * gravity);
    return free - x * (x.dot(free) + v.squaredNorm()) / x.squaredNorm();  // of x . a = -|v|^2
  }
  double density() const {
    const Eigen::Vector2d a = acceleration(), e = x.normalized();
    const double rate = v.norm() / length, bend = std::abs(e[0] * a[1] - e[1] * a[0]) / length;
    // v h + b h^2 / 2 = alpha for h = alpha / omega.
    const double h = bend > 1e-9 ? (std::sqrt(rate * rate + 2 * bend * turn) - rate) / bend : turn / rate;
    const double r = a.norm() / (v.norm() + a.norm() * longest / turn);
    return std::sqrt(1 + std::pow(longest * (turn / h + r) / turn, 2));
  }
};

// Of one that others follow, each the geometric mean of what is wanted at its ends.
double first_step(const Rod& rod) {
  const double wanted = longest / rod.density();
  const Eigen::Vector2d a = rod.acceleration();
  double h = wanted;
  for (int round = 0; round < 3; ++round) {
    const Rod there{rod.x + h * rod.v + 0.5 * h * h * a, rod.v + h * a, rod.gravity};
    h = std::sqrt(wanted * longest / there.density());
  }
  return h;
}

double told(const Rod& rod) {
  CustomSpec spec;
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true},
                {"A", {rod.x[0], 0, rod.x[1]}, {rod.v[0], 0, rod.v[1]}, 0.0, false}};
  spec.rods = {{"OA", {"O", "A"}, 2.0}};
  Structure structure = build_custom(spec);
  structure.gravity = {0, 0, -rod.gravity};
  const auto model = make_model(structure);
  SolverOptions options = dvm_options(3, longest, 1);
  options.turn = turn;
  StepControl control(model->structure, model->system, options);
  return control.next(initial_state(model->structure, model->system).state);
}

}  // namespace

TEST_CASE("the first step leads to where the motion goes to second order, whether it turns or falls") {
  const double tilt = 0.37;
  const Eigen::Vector2d along = length * Eigen::Vector2d(std::cos(tilt), std::sin(tilt)),
                        across(-along[1], along[0]);
  for (const double rate : {2.6, 0.4, -1.9, 0.0})
    for (const double gravity : {0.0, g}) {
      if (rate == 0 && gravity == 0) continue;
      INFO(rate << " rad/s, " << gravity << " m/s^2");
      const Rod rod{along, rate * across, gravity};
      // Where it is led to, the rod is longer by some (rate h)^4: 1e-4 of the parts that grow with length.
      CHECK(told(rod) == Approx(first_step(rod)).epsilon(1e-6));
    }
}

}  // namespace first_step_test
