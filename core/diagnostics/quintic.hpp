// SPDX-License-Identifier: BSD-3-Clause
// The motion within a step, from the states at its ends.
#pragma once

#include "core/system/state.hpp"

namespace unfurl {

// Quintic Hermite interpolation on a step of length h at u = (t - t_0) / h, through coordinates, rates and
// accelerations at both ends: of order 6 where the motion is smooth.
struct Quintic {
  const State &a, &b;
  const VectorXd &accel_a, &accel_b;
  double h;

  VectorXd value(double u) const {
    const double v = 1 - u, u3 = u * u * u, v3 = v * v * v;
    return v3 * (1 + 3 * u + 6 * u * u) * a.z + h * u * v3 * (1 + 3 * u) * a.w +
           h * h / 2 * u * u * v3 * accel_a + u3 * (1 + 3 * v + 6 * v * v) * b.z -
           h * v * u3 * (1 + 3 * v) * b.w + h * h / 2 * v * v * u3 * accel_b;
  }
  VectorXd rate(double u) const {
    const double v = 1 - u, u2 = u * u, v2 = v * v;
    return 30 * u2 * v2 / h * (b.z - a.z) + v2 * (1 - 3 * u) * (1 + 5 * u) * a.w +
           u2 * (1 - 3 * v) * (1 + 5 * v) * b.w + h / 2 * u * v2 * (2 - 5 * u) * accel_a -
           h / 2 * v * u2 * (2 - 5 * v) * accel_b;
  }
};

}  // namespace unfurl
