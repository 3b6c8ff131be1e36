#pragma once

#include "core/math/types.hpp"

namespace unfurl {

/// Singular values of a dense matrix, the largest first; as many as the smaller of its sizes. Householder
/// bidiagonalisation, then the eigenvalues of the symmetric tridiagonal matrix with a zero diagonal that has
/// the same singular values (Golub & Kahan 1965). The error of each is some 1e-16 of the largest. Throws
/// std::runtime_error when the iteration does not converge (entries that are not finite).
VectorXd singular_values(const MatrixXd& matrix);

}  // namespace unfurl
