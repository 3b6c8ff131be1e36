// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/pendulum.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace pendulum_test {

namespace {

constexpr double g = 9.81;

Simulation swing(const Changes& changes, double end_time, int steps) {
  Structure s = family_structure("pendulum", changes);
  s.gravity = {0, 0, -g};
  return simulate(make_model(s), dvm_options(5, end_time / steps, end_time));
}

}  // namespace

TEST_CASE("a pendulum is back at its start after the period of the elliptic integral") {
  // omega_0^2 = g l (m/2 + M) / I with I = (m/3 + M) l^2; period 4 K(sin(alpha/2)) / omega_0 (Landau &
  // Lifshitz, Mechanics, section 11).
  for (const auto& [rod, bob] : {std::pair{1.0, 0.0}, {0.0, 2.0}, {0.7, 0.4}})
    for (const double alpha : {20.0, 90.0, 170.0}) {
      const double l = 0.8, omega = std::sqrt(g * (rod / 2 + bob) / ((rod / 3 + bob) * l));
      const double period = 4 * std::comp_ellint_1(std::sin(0.5 * alpha * radians_per_degree)) / omega;
      const Simulation run =
          swing({{"length", l}, {"rod_mass", rod}, {"bob_mass", bob}, {"angle", alpha}}, period, 400);
      INFO(rod << " kg rod, " << bob << " kg bob, " << alpha << " degrees: " << run.message);
      REQUIRE(run.status == RunStatus::completed);
      const VectorXd error =
          run.trajectory.positions(run.trajectory.size() - 1) - run.trajectory.positions(0);
      // Order 8, 400 steps a period: below 1e-10 of the length even where the swing hesitates near the top.
      CHECK(error.lpNorm<Eigen::Infinity>() <= 1e-10);
      // Half way it stands mirrored.
      const Vec3 middle = run.trajectory.positions(run.trajectory.size() / 2).segment<3>(3);
      CHECK(middle.x() == Approx(-l * std::sin(alpha * radians_per_degree)).epsilon(1e-9));
    }
}

TEST_CASE("a conical pendulum keeps its height and turns at its steady rate") {
  const double l = 1.2, rod = 0.5, bob = 0.8, angle = 50 * radians_per_degree;
  const double rate = std::sqrt(g * l * (rod / 2 + bob) / ((rod / 3 + bob) * l * l * std::cos(angle)));
  const Simulation run = swing({{"length", l},
                                {"rod_mass", rod},
                                {"bob_mass", bob},
                                {"angle", 50.0},
                                {"azimuth_rate", rate / radians_per_degree}},
                               3.0, 300);
  REQUIRE(run.status == RunStatus::completed);
  for (std::size_t i = 0; i < run.trajectory.size(); i += 20) {
    const double turned = rate * run.trajectory.time(i);
    const Vec3 expected(l * std::sin(angle) * std::cos(turned), l * std::sin(angle) * std::sin(turned),
                        -l * std::cos(angle));
    CHECK((run.trajectory.positions(i).segment<3>(3) - expected).norm() <=
          1e-12);  // order 8 at 0.03 rad a step
  }
}

TEST_CASE("a pendulum without mass is refused") {
  CHECK(refusal("pendulum", {{"rod_mass", 0.0}}) ==
        "rod_mass: rod_mass and bob_mass are both 0: give one of them a mass");
}

}  // namespace pendulum_test
