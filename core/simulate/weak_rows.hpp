// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/simulate/free_motion.hpp"

namespace unfurl {

// How weakly rows hold a pose, by what they and masses join: a part that is near a pose of its own in which
// rows lose rank, and stays there, says nothing of the way to another one's.
class WeakRows {
 public:
  explicit WeakRows(const System& system);  // which must outlive it

  // How many are weaker (SaddleSolver::rows_below).
  Index below(const State& state, double bound);
  // The smallest pivot, looked for below `bound`, of parts that count: all, at first.
  double pivot(const State& state, double bound);
  // From now on those whose pivot falls to such a share on the way from one state to the other; all, where
  // none does.
  void count_falling(const State& from, const State& to, double share);
  // Does one that does not count become weaker than `bound` on that way?
  bool another_falls(const State& from, const State& to, double bound);

 private:
  std::vector<FreeMotion> parts_;
  std::vector<bool> counts_;
};

}  // namespace unfurl
