// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/independent_parts.hpp"
#include "core/integrators/row_noise.hpp"
#include "core/math/saddle_solver.hpp"

namespace unfurl {

// What counts as round-off in each of several independent parts, by its own coordinates, masses and motion.
class PartSizes : public IndependentParts {
 public:
  explicit PartSizes(const System& system);
  void start(const RowNoise& rows);                      // at the pose that these have
  double reach(Index r) const { return row_reach_[r]; }  // of constraint row r
  // At least so large are the terms of a coordinate: one size for all of a part where it does no harm there
  // (harmless_noise), else a trifle of what does none. `of_rows` times `scale` is what they are of momenta
  // within a step, over its length.
  VectorXd harmless(const VectorXd& of_rows, double scale) const;
  // The largest pivot below which errors at round-off show in the motion of a part, each by its own, of parts
  // that may have one, and no more than that of `strong`; 0: of none. `always`: some part moves so little
  // that every error shows.
  struct Care {
    double pivot = 0;
    bool always = false;
  };
  Care care(const SaddleSolver& saddle, const VectorXd& motion, double harmless, double strong) const;

 private:
  const System& system_;
  VectorXd row_reach_, part_reach_, least_mass_;
};

}  // namespace unfurl
