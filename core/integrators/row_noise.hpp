// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/system/system.hpp"

namespace unfurl {

// Coordinates beyond so many times the shortest length are far: rows then go by the reach of their own nodes.
inline constexpr double far_reach = 1e4;
// One size will do for all rows where what is round-off by it moves no mass within a step by more than so
// many times what rounding the coordinates does, give or take.
inline constexpr double harmless_noise = 5;

// The sizes of the terms that cancel in each row of the momentum equations, for residuals in units of what
// round-off leaves of them. One size for all rows lets what is heavy or stiff hide the motion of what is
// light: of a pendulum of 1e-6 kg beside 1e9 kg on a rod nothing is left.
// Sizes are of one unit: whatever the caller adds, forces or impulses.
class RowNoise {
 public:
  explicit RowNoise(const System& system);
  void start(const ConstVec& q);                          // at this pose (node coordinates): all sizes zero
  void start_with(const VectorXd& reach);                 // the same, where coordinates reach so far
  void restart(const VectorXd& sizes) { size_ = sizes; }  // at the same pose, with what was added then
  void add(const ConstVec& own) { size_ += own.cwiseAbs(); }  // of the rows themselves
  void add_forces(const ConstVec& f);                         // on the nodes
  // Of constraint forces `scale` lambda: rows have unit gradients, whose direction is known to what rounding
  // the coordinates leaves.
  void add_multipliers(const ConstVec& lambda, double scale);
  void add_multiplier(Index r, double force) {  // of row r; force >= 0
    force *= far_[r];
    for (SparseRows::InnerIterator it(pattern_, r); it; ++it) size_[it.col()] += force;
  }
  void add_inertia(const ConstVec& x, double scale) { add_products(system_.mass(), x, scale); }  // |M| |x|
  void add_products(const SparseRows& A, const ConstVec& x, double scale);                       // |A| |x|
  // What rounding the coordinates changes in forces of these derivatives, over round-off.
  void add_stiffness(const SparseRows& by_z, double scale) { add_products(by_z, reach_, scale); }

  const VectorXd& size() const { return size_; }
  // The largest coordinate of the nodes that constraint row r depends on [m].
  double reach(Index r) const;

 private:
  const System& system_;
  SparseRows pattern_;               // of G
  VectorXd size_, reach_, reduced_;  // reach_: of the nodes that follow a solved coordinate
  VectorXd far_;                     // of each row: its reach in its own length, at least 1
};

// Of each row the sum of |A_ij| / sqrt(m_i m_j), with masses m (System::moving_mass): A = dF/dz' gives a
// bound of c / m [1/s], dF/dz of k / m [1/s^2].
VectorXd rate_bounds(const SparseRows& A, const VectorXd& m);
double rate_bound(const SparseRows& A, const VectorXd& m);  // the largest
// The largest |A_ij| of finite masses.
double largest_of_moving(const SparseRows& A, const VectorXd& m);

}  // namespace unfurl
