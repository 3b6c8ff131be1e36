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
  void look(double t, const VectorXd& q, const VectorXd& v);  // which forces join what (allocates)
  void start(const VectorXd& q);                              // at this pose (node coordinates)
  // Of each coordinate the largest one of the nodes that it moves and that forces on these depend on.
  const VectorXd& reaches() const { return reaches_; }
  // Of constraint row r the reach of its part, or, where that is far beyond the shortest length, its own.
  double reach(Index r, const RowNoise& rows) const {
    const Index p = of_row(r);
    return part_reach_[p] <= far_reach * shortest_[p] ? part_reach_[p] : rows.reach(r);
  }
  // At least so large are the terms of each coordinate: a trifle of what does no harm (harmless_noise), where
  // they are of momenta within a step over `scale`.
  VectorXd least(double scale) const;
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
  void place();

  SparseRows felt_;  // System::felt_coordinates
  VectorXd q_, reaches_;
  VectorXd part_reach_, least_mass_, shortest_;  // shortest_: length of a constraint
};

}  // namespace unfurl
