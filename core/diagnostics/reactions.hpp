// SPDX-License-Identifier: BSD-3-Clause
// What the ground gives a structure where it is held.
//
// A support is a node that a constraint ties to the ground: one that is fixed, held in a plane or on a line,
// or whose coordinate is held, driven, stopped or stuck by friction. Lengths, angles and relations between
// nodes hold a structure together; planes and mirrors of a family that only say that it is flat or symmetric
// (Constraint::symmetry) and those of a sector are no supports.
//
// The equations of motion in node coordinates, with the rows A that were eliminated, are
//
//     M a + G^T lambda + A^T mu = F,
//
// so that A^T mu follows from what is known at a state, and mu, of least norm, from it. The reaction is what
// the rows of supports, in G and in A, give their node.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/math/saddle_solver.hpp"

namespace unfurl {

// Columns of each support: NAME.reaction_N, its size; .reaction_x_N ..._y_N ..._z_N; .reaction_unique, 1
// until mark_reactions().
class ReactionColumns {
 public:
  // `first`: the model that the run begins with; what it may touch later is a support from the start.
  ReactionColumns(const Model& first, std::vector<Series>& columns);
  // `system`: of the model, near the angles of the state; a: accelerations of the nodes; lambda: multipliers
  // of the kept rows.
  void append(const Model& model, const System& system, const State& state, const VectorXd& q,
              const VectorXd& v, const VectorXd& a, const VectorXd& lambda);

 private:
  void enter(const Model& model);

  std::vector<Series>& columns_;
  std::size_t first_;
  std::vector<int> supports_;
  const Model* model_ = nullptr;
  VectorXd kept_, linear_;  // 1: a row of a support, of the kept ones and of those of rows_
  struct Held {
    Index row;
    int node;
    Vec3 change;
  };
  std::vector<Held> measured_;  // of rows that hold a measure: what of it the ground holds, and how
  SparseRows rows_;             // of the node coordinates, constant; empty: nothing was eliminated
  std::unique_ptr<SaddleSolver> solver_;
};

// Nodes of the structure that are supports, ascending.
std::vector<int> supports(const Structure& structure);

// Enters which reactions are unique: all of their coordinates, each a sum over the support's rows. waves[i],
// 1: none is at state i (followed_forces()).
void mark_reactions(const Trajectory& trajectory, const ForceUniqueness& uniqueness,
                    const std::vector<char>& waves, Diagnostics& diagnostics);

// Of a column NAME.reaction_N, which has a corner where a reaction passes nothing: the first states of steps
// over which the straight line from one to the next does so most nearly. None of other columns.
std::vector<std::size_t> reaction_dips(const Diagnostics& diagnostics, std::string_view column);

// The largest magnitude of a support's reaction over the states.
struct PeakReaction {
  int node = 0;          // of the solved structure
  double force_N = 0.0;  // NaN: never known
  double t = 0.0;        // [s]
  bool unique = true;    // at that state
};
std::vector<PeakReaction> peak_reactions(const Structure& structure, const Diagnostics& diagnostics);

}  // namespace unfurl
