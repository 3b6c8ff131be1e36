// SPDX-License-Identifier: BSD-3-Clause
// How near rods come to each other while a structure moves, and whether they pass through one another: a
// mechanism of lines knows nothing of that.
#pragma once

#include <optional>

#include "core/simulate/trajectory.hpp"

namespace unfurl {

/// The nearest that two rods come which do not meet in a node.
struct Clearance {
  double distance = 0;          // between their surfaces; negative: they overlap [m]
  double axes = 0;              // between their axes [m]
  int rod_a = 0, rod_b = 0;     // of the whole structure's rods, a before b
  double t = 0;                 // when, the first time [s]
  std::size_t overlapping = 0;  // pairs whose surfaces overlap in one of the poses at least
  std::size_t states = 0;       // that were looked at
};

/// Rods as cylinders of their radius (where it is not known, as lines) with round ends, at the first `states`
/// states of a motion, and where rods move by more than the thinnest is thick in a step at up to 63 poses
/// between; of the nearest pair also between the states beside that one. Rods with a common node, with ends
/// that stay in one place, or with a pin through both (a node on both) meet there and are left out. None
/// where no two are left.
std::optional<Clearance> least_clearance(const Trajectory& trajectory, std::size_t states);

/// The distance of the segments a0 a1 and b0 b1 [m].
double segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

}  // namespace unfurl
