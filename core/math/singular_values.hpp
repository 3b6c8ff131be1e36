// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "core/math/types.hpp"

namespace unfurl {

/// Singular values of a dense matrix, the largest first; as many as the smaller of its sizes. Householder
/// bidiagonalisation, then the eigenvalues of the symmetric tridiagonal matrix with a zero diagonal that has
/// the same singular values (Golub & Kahan 1965). The error of each is some 1e-16 of the largest. NaN
/// throughout where an entry is not finite.
VectorXd singular_values(const MatrixXd& matrix);

/// The same of a square bidiagonal matrix, upper: its first entry, the one beside it, the next of the
/// diagonal and so on. by_bisection: not by the quicker iteration that is tried first and may not converge.
VectorXd singular_values_of_bidiagonal(const VectorXd& entries, bool by_bisection = false);

/// That bidiagonal matrix of a matrix whose entries are finite: n on the diagonal and n - 1 beside it, in
/// turn, n the smaller of its sizes.
VectorXd bidiagonal_of(const MatrixXd& matrix);

/// A few singular values of a bidiagonal matrix, for a fraction of the price of all: the k-th largest for
/// each k of `which` (0: the largest), by bisection. The error of each is some 1e-16 of the largest.
VectorXd singular_values_at(const VectorXd& entries, std::span<const Index> which);

/// How many singular values of a bidiagonal matrix are at least x > 0.
Index singular_values_above(const VectorXd& entries, double x);

/// How many of a dense matrix are, and how many are at least this share of the largest, for half the price of
/// all. None where an entry is not finite.
Index rank_above(const MatrixXd& matrix, double x);
Index rank_within(const MatrixXd& matrix, double share);

}  // namespace unfurl
