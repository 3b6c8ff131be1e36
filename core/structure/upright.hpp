// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "core/math/types.hpp"

namespace unfurl {

// The rotation after which gravity points along -z, as all that is shown has it; none without gravity.
inline Mat3 upright_rotation(const Vec3& gravity) {
  if (gravity.isZero()) return Mat3::Identity();
  return Eigen::Quaterniond::FromTwoVectors(-gravity, Vec3::UnitZ()).toRotationMatrix();
}

}  // namespace unfurl
