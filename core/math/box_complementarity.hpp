// SPDX-License-Identifier: BSD-3-Clause
// Pushes that are bounded and what they hold: the complementarity problem of stops and dry friction.
#pragma once

#include <optional>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// With D symmetric and positive semidefinite, w = D x + b and low <= x <= high,
//
//     x = low: w >= 0,     x = high: w <= 0,     between: w = 0
//
// (what minimises x^T D x / 2 + b^T x in the box). A stop has the box [0, inf): its push x and the gap's
// acceleration w; dry friction [-tau, tau]: its force and the acceleration of what it holds. Where D is
// singular w is unique and x need not be.
struct BoxSolution {
  VectorXd x, w;
  // Rows that are held at w = 0; those of D are independent. Others rest at a bound, or at 0 where w = 0 by
  // itself or by what the held rows hold.
  std::vector<bool> held;
};

// Nothing where no x does it: a push without a bound that cannot stop what it must. `rounding`: what each row
// of b may be off by, where that is more than 1e-12 of it; empty: it is not.
std::optional<BoxSolution> solve_box(const MatrixXd& D, const VectorXd& b, const VectorXd& low,
                                     const VectorXd& high, const VectorXd& rounding = {});

// d with d_i = 1, (D d)_k = 0 for the rows k that are held, and zero for others.
VectorXd past_held(const MatrixXd& D, const std::vector<bool>& held, Index i);

// Is row i of D independent of those held? Of unit diagonal, what they leave of it is above round-off.
bool independent(const MatrixXd& D, const std::vector<bool>& held, Index i);

// Of a solution with held rows of which i is not independent, another one, with the same w; `pushes`: rows
// that push, as stops do, and never pull.
// What i bears goes over to those held, or i is held in place of the first that pushes and would have to
// pull.
void give_over(const MatrixXd& D, const std::vector<bool>& pushes, Index i, BoxSolution& solution);
// i bears until one of those held bears nothing, and is held in its place, if that is none that pushes, and
// none is at a bound before.
void take_over(const MatrixXd& D, const VectorXd& low, const VectorXd& high, const std::vector<bool>& pushes,
               Index i, BoxSolution& solution);

// Sets of rows that D does not join, neither directly nor by others: each has an answer of its own. D:
// symmetric, its diagonal not negative; entries below 1e-9 of what they could be are rounding.
std::vector<std::vector<Index>> joined_rows(const MatrixXd& D);

}  // namespace unfurl
