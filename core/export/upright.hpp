// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "core/math/types.hpp"

namespace unfurl {

// Of two directions the one to the other, without a spin; compiled once: Eigen decomposes a matrix for it.
Eigen::Quaterniond shortest_turn(const Vec3& from, const Vec3& to);

// The rotation after which gravity points along -z, as all that is shown has it; none without gravity.
Mat3 upright_rotation(const Vec3& gravity);

}  // namespace unfurl
