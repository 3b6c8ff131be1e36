// SPDX-License-Identifier: BSD-3-Clause
// What dry friction can hold where several frictions stick that cannot move but together.
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// Frictions i of a mechanism at rest are held by constraints that are independent, with forces lambda_i; each
// of the others, j, would have to move with them, ds_j = sum_i c_ji ds_i, and rests. Nothing says who carries
// how much: they hold as long as there is any
//
//     x_i + sum_j c_ji x_j = lambda_i     with |x| <= tau of each.
//
// Among both may be stops, whose tau is infinite: they push as much as they must, x >= 0.
//
// Of all that are connected by c that is one condition, lambda = t l with the largest t >= 1 that there is an
// x for: their capacity is |t l|, largest entry, beside their load |l|.
struct FrictionHold {
  std::vector<Index> held;
  double load = 0.0, capacity = 0.0;  // in the unit of what has the largest share of the load
};

// c: resting by held; lambda, tau of the held ones; tau of the resting ones.
std::vector<FrictionHold> friction_holds(const MatrixXd& c, const VectorXd& lambda, const VectorXd& tau_held,
                                         const VectorXd& tau_resting);

}  // namespace unfurl
