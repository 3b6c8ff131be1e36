// SPDX-License-Identifier: BSD-3-Clause
// How far a structure has come on its way, by a fold angle and by a measure.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/structure/structure.hpp"

using namespace unfurl;

namespace deployment_test {

namespace {

// The fold angle is that of the second node as seen from the first one, in a plane of its own.
const Vec3 first = Vec3(2, -1, 2) / 3, second = Vec3(1, 2, 0) / std::sqrt(5.0);

Deployment fold(double deployed) {
  Deployment d;
  d.fold_sine = {{0, 1}, {-second, second}, 0.0};
  d.fold_cosine = {{0, 1}, {-first, first}, 0.0};
  d.initial_fold_angle = 0.2;
  d.deployed_fold_angle = deployed;
  return d;
}

VectorXd at_angle(double angle, const Vec3& from) {
  VectorXd q(6);
  q << from, from + std::cos(angle) * first + std::sin(angle) * second;
  return q;
}

}  // namespace

// sin(fold - deployed) within a right angle, and beyond it what is left of the two that half a turn has.
TEST_CASE("what is left of a fold angle is its sine and beyond a right angle goes on to two") {
  for (const double deployed : {0.6, 1.3, -0.4})
    for (double off = -3.1; off < 3.1; off += 0.0973) {
      INFO("deployed at " << deployed << ", " << off << " off");
      const Deployment d = fold(deployed);
      const VectorXd q = at_angle(deployed + off, Vec3(0.3, 0.1, -0.7));
      const double s = std::sin(off), wanted = std::cos(off) >= 0 ? s : std::copysign(2 - std::abs(s), s);
      CHECK(d.remaining(q) == Approx(wanted).epsilon(0).margin(1e-14));
      // Along the arc at 1.7 rad/s; next to where it bends, at a right angle, both sides have the slope 0.
      VectorXd v = VectorXd::Zero(6);
      v.tail<3>() = 1.7 * (-std::sin(deployed + off) * first + std::cos(deployed + off) * second);
      CHECK(d.remaining_rate(q, v) == Approx(1.7 * std::abs(std::cos(off))).epsilon(0).margin(1e-13));
      CHECK(d.fold_rate(q, v) == Approx(1.7).epsilon(1e-13));
    }
}

// A number x is off by eps |x| / 2 at most: coordinates of some size, each at its worst, by sum |ds/dx| times
// that. Sixteen eps leave room for the sums; half as much again is no share of it.
TEST_CASE("what rounding leaves far from the origin counts as nothing of what is left") {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  Deployment length;
  length.measured = true;
  length.measure = {MeasureKind::length, {0, 1}, Vec3::Zero(), 0.0, {}};
  length.stowed = 0.3, length.deployed = 1.9;
  const Vec3 along = (std::cos(0.5) * first + std::sin(0.5) * second).normalized();
  for (const double far : {4e3, -7e5}) {
    INFO(far);
    const VectorXd q = at_angle(0.5, far * Vec3(0.2, -0.6, 1));
    const double reach = q.lpNorm<Eigen::Infinity>(), by_length = 2 * along.lpNorm<1>() / 1.6,
                 by_fold = 2 * second.lpNorm<1>();
    CHECK(length.rounded(q) == Approx(16 * eps * reach * by_length).epsilon(1e-6));
    CHECK(fold(0.6).rounded(q) == Approx(16 * eps * reach * by_fold).epsilon(1e-12));
  }
  const VectorXd near = at_angle(0.5, Vec3(0.2, -0.6, 1));
  CHECK(length.rounded(near) == 1e-12);
  CHECK(fold(0.6).rounded(near) == 1e-12);
}

}  // namespace deployment_test
