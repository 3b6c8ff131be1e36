// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "core/structure/structure.hpp"

namespace unfurl {

// How much longer a rod is than the length that it is held at then, of solved nodes at q [m]; NaN for a rod
// that gives, which is held at none.
inline double length_error(const Rod& rod, const VectorXd& q, double t) {
  if (rod.gives) return std::numeric_limits<double>::quiet_NaN();
  return (q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a)).norm() - rod.length * (1 + rod.warmed(t));
}

}  // namespace unfurl
