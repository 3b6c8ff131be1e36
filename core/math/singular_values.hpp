// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace unfurl
