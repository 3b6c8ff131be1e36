// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/saddle_solver.hpp"
#include "core/math/types.hpp"

namespace unfurl {

/// Forces of least complementary energy among those that balance the same loads: of all y with the same
/// G^T y, the one that minimises
///
///     1/2 sum_i c_i y_i^2,      c_i >= 0: compliance of row i
///
/// which is how elastic members share a load in the limit of stiff ones (Castigliano, Menabrea). Rows with
/// c_i = 0 are ideal guides and cost nothing. What they leave open among themselves stays as it is given.
///
/// y = y_0 + d with G^T d = 0. The minimum without the guides' own part is found by proximal steps on them,
///
///     min  1/2 sum_members c_i (y_0 + d)_i^2 + p/2 sum_guides |g_i|^2 (d - d_before)_i^2,     G^T d = 0
///
/// a saddle-point system with a positive diagonal that is factorised once. A step leaves the share p / (p +
/// s) of a direction in which the members have the compliance s; without redundant guides one is enough. So
/// that s is not far below p, p goes by the stiffest member, however soft others are.
class LeastEnergy {
 public:
  /// G: its pattern. compliance: one for every row, not all zero.
  LeastEnergy(const SparseRows& G, VectorXd compliance);
  /// y: the given forces; overwritten. False, and y as it was, where the factorisation broke down or the
  /// steps come to no end.
  bool share(const SparseRows& G, MutVec y);

 private:
  bool by_whole_steps(const MutVec& y, double size);
  bool by_small_steps(const SparseRows& across, const MutVec& y, double size);

  VectorXd compliance_;  // relative to the mean of those that are not zero
  SaddleSolver solver_;
  VectorXd norm_, force_, change_, step_, displacement_;
};

}  // namespace unfurl
