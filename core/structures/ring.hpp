// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "core/math/types.hpp"

namespace unfurl {

// Unit vectors at a polar angle [rad] about the z axis: away from it and around it.
inline Vec3 radial(double angle) {
  return {std::cos(angle), std::sin(angle), 0.0};
}
inline Vec3 tangential(double angle) {
  return {-std::sin(angle), std::cos(angle), 0.0};
}

}  // namespace unfurl
