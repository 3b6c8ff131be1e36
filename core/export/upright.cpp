// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/upright.hpp"

namespace unfurl {

Eigen::Quaterniond shortest_turn(const Vec3& from, const Vec3& to) {
  // Next to opposite directions its length is off by 5e-6, and lengths turned by it by twice that.
  return Eigen::Quaterniond::FromTwoVectors(from, to).normalized();
}

Mat3 upright_rotation(const Vec3& gravity) {
  return gravity.isZero() ? Mat3(Mat3::Identity())
                          : shortest_turn(-gravity, Vec3::UnitZ()).toRotationMatrix();
}

}  // namespace unfurl
