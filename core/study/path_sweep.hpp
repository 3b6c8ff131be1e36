// SPDX-License-Identifier: BSD-3-Clause
// Points of a sweep at the price of their physics: a scene read once, a path traced once for all points that
// share it, a quadrature for each.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/study/sweep.hpp"

namespace unfurl {

// Where a family's structure is released at rest and deploys under constant loads, all that events tell of a
// run is the time from its pose to the deployed one (path/path_time.hpp). The path is traced from the first
// values of those axes that keep it (a fold angle, a force) and the point's own values of the others, so that
// a point's digits are the same in whatever order or shard points are computed. Each point's structure is
// built, and must be that of its path in another pose: whatever else is different goes the usual way.
class PathSweep {
 public:
  explicit PathSweep(const SweepPlan& plan);
  ~PathSweep();
  // Appends outcome and measures; false where the point goes the usual way. Threads may share it.
  bool measure(std::size_t point, std::vector<std::string>& row) const;

 private:
  struct Traced;
  struct Data;
  std::unique_ptr<Data> data_;  // empty: no point can
};

}  // namespace unfurl
