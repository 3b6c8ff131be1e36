// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/path/margin_motion.hpp"

namespace unfurl {

// Where the way of a margin ends: the pose, dq/ds the way it goes, what pushes on along it at rest, of the
// whole structure, and the speed ds/dt with which the motion gets there (NaN: it does not).
struct WayEnd {
  double sense = 1.0, s = 0.0;
  VectorXd q, dq;
  double push = 0.0, speed = 0.0;
};

// Loads of the stops that the way ends on and, if it ends in the deployed pose and `latches`, of those. Where
// there are several, each as if it alone held the structure; latches of a structure that has one for each of
// its parts are first told together, then one by itself, all bearing alike (with the least sum of squares).
std::vector<MarginLoad> loads_at_end(const Structure& structure, const MarginMotion& motion,
                                     const WayEnd& end, bool latches);

}  // namespace unfurl
