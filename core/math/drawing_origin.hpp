// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "core/math/types.hpp"

namespace unfurl {

// Where what is drawn in single precision has its zero: at `given`, unless a motion (its middle, and how far
// it reaches from there [m]) lies a hundred times its size away. Numbers that count from `given` have then
// steps of 6e-6 of that size and more; those from a round point beside the motion have not.
inline Vec3 drawing_origin(const Vec3& center, double radius, const Vec3& given = Vec3::Zero()) {
  const double size = radius > 0 ? radius : 1;
  if (!center.allFinite() || !((center - given).norm() > 100 * size)) return given;
  const double round = std::pow(10.0, std::ceil(std::log10(10 * size)));  // also of the lines of a floor
  return (center / round).array().round() * round;
}

}  // namespace unfurl
