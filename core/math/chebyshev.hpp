// SPDX-License-Identifier: BSD-3-Clause
// Series of Chebyshev polynomials on [-1, 1], p(x) = sum_k c_k T_k(x) (Trefethen 2013).
#pragma once

#include "core/math/types.hpp"

namespace unfurl {

// The n + 1 extrema of T_n, ascending from -1 to 1.
VectorXd chebyshev_points(int n);

// [n + 1 x n + 1]: coefficients = values at those points (a row) times this matrix.
const MatrixXd& chebyshev_transform(int n);

struct ValueAndSlope {
  double value = 0.0, slope = 0.0;
};

// Clenshaw's recurrence b_k = c_k + 2 x b_{k+1} - b_{k+2}; c has `size` entries. The slope is by x.
double chebyshev_value(const double* c, Index size, double x);
ValueAndSlope chebyshev_value_and_slope(const double* c, Index size, double x);

// (p(x) - p(y)) / (x - y), without the cancellation that this has for near x and y: the same recurrence for
// the differences of b_k, d_k = 2 b_{k+1}(y) + 2 x d_{k+1} - d_{k+2}. For x = y it is the slope.
double chebyshev_divided_difference(const double* c, Index size, double x, double y);

// Of a series with vectors for coefficients: columns of c [dimension x size].
void chebyshev_value(const MatrixXd& c, double x, MutVec out);

// P with P' = p and P(-1) = 0, one coefficient more.
VectorXd chebyshev_integral(const VectorXd& c);

}  // namespace unfurl
