// SPDX-License-Identifier: BSD-3-Clause
// The times at which the steps of a run end.
#pragma once

#include <vector>

#include "core/integrators/solver_options.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {

// With a solver.step that is no longer than the run: what counts as one time or as at rest is a share of it.
SolverOptions with_steps_inside(SolverOptions options);

// A regular grid of solver.step from the start, or steps of a size that is asked for each, cut where time has
// edges. Where a velocity jumps at t, the step before it ends at the last number before t, so that all it
// evaluates is what was before the jump, and the next one begins at t.
class TimeGrid {
 public:
  TimeGrid(double start, const SolverOptions& options, std::vector<TimeEdge> edges);

  struct Target {
    double t;           // where the next step ends [s]
    double h;           // its size: exactly solver.step where the grid lets it, so that matrices can be kept
    bool edge = false;  // time has an edge there: what a method learnt from the steps before it holds no more
    bool jumps = false;  // a velocity jumps right behind t, at `jump` [s]
    double jump = 0.0;
  };
  Target next(double now) const;                 // the regular grid
  Target next(double now, double wanted) const;  // a step of the size wanted, somewhat longer before the end
  double end() const { return end_; }
  double next_edge(double now) const;  // or the end

 private:
  Target cut(double now, Target target) const;

  double start_, step_, end_;
  long count_;
  std::vector<TimeEdge> edges_;
};

}  // namespace unfurl
