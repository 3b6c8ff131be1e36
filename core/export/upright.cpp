// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/upright.hpp"

namespace unfurl {

Eigen::Quaterniond shortest_turn(const Vec3& from, const Vec3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Mat3 upright_rotation(const Vec3& gravity) {
  return gravity.isZero() ? Mat3(Mat3::Identity())
                          : shortest_turn(-gravity, Vec3::UnitZ()).toRotationMatrix();
}

}  // namespace unfurl
