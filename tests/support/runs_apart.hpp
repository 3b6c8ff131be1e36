// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include "core/simulate/simulation.hpp"
#include "core/study/reference.hpp"

namespace unfurl::testing {

// The farthest that a node of one run is from that of another at the first one's times [m]; infinite where
// the other has not all but two of these, to within `same_time` [s].
inline double runs_apart(const Simulation& a, const Simulation& b, double same_time = 1e-9) {
  double largest = 0;
  std::size_t k = 0, shared = 0;
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    while (k < b.trajectory.size() && b.trajectory.time(k) < a.trajectory.time(i) - same_time) ++k;
    if (k == b.trajectory.size()) break;
    if (b.trajectory.time(k) > a.trajectory.time(i) + same_time) continue;
    ++shared;
    largest = std::max(largest, node_distance(a.trajectory.positions(i), b.trajectory.positions(k)));
  }
  return shared + 2 >= a.trajectory.size() ? largest : std::numeric_limits<double>::infinity();
}

}  // namespace unfurl::testing
