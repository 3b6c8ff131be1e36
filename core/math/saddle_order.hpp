// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

/// Approximate minimum degree order of a symmetric pattern given by its upper triangle: [k] is the row that
/// is eliminated k-th.
std::vector<int> minimum_degree_order(const SparseRows& upper);

/// Orders of elimination of K_e = [M G^T; G -e], rows of M first, as core/math/saddle_solver.hpp has it. Both
/// start from the minimum degree order of the pattern `upper` of K_e and move constraints behind coordinates,
/// since a constraint that is eliminated before all of them has the pivot -e, and brings growth by 1/e.
struct SaddleOrders {
  /// Every constraint behind all the coordinates that it acts on: its pivot is of order one unless the
  /// constraint is redundant or weak, whatever the values of G are.
  std::vector<int> safe;
  /// Every constraint behind a coordinate of its own, on which it acts with no less than a tenth of its
  /// largest entry in `G`: constraints that have eliminated coordinates of their own are independent of each
  /// other there, so that no pivot is near -e while G is near the G of this order. Constraints without one
  /// are where the safe order has them. About half of the fill.
  std::vector<int> sparse;
};
SaddleOrders saddle_orders(const SparseRows& upper, const SparseRows& G);

}  // namespace unfurl
