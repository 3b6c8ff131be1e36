// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/upright.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace unfurl;

// A quaternion of the length 1 + d turns lengths to 1 + 2 d times as much; of two almost opposite directions
// d was 5e-6. Left is the rounding of a matrix of products and sums; and of the direction, where 1 + cos(pi -
// e), of numbers with 1e-16, tells e to sqrt(1e-16) at most.
TEST_CASE("gravity that points almost up turns what is shown without stretching it") {
  for (const double e : {0.0, 1e-7, 1e-6, 1.5e-6, 3e-6, 6.7e-6, 1e-5, 1e-4, 1e-3, 0.1, 3.0}) {
    INFO(e);
    const Vec3 gravity = 9.81 * Vec3(0.6 * std::sin(e), 0.8 * std::sin(e), std::cos(e));
    const Mat3 turn = upright_rotation(gravity);
    CHECK((turn * turn.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
    CHECK((turn * gravity + 9.81 * Vec3::UnitZ()).norm() < 1e-8 * gravity.norm());
  }
}
