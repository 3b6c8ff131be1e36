// SPDX-License-Identifier: BSD-3-Clause
// Gauss quadrature on [0, 1], computed to round-off rather than tabulated.
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

struct Quadrature {
  VectorXd nodes;    // ascending, in [0, 1]
  VectorXd weights;  // sum 1
};

// n points; exact for polynomials of degree 2 n - 1.
Quadrature gauss_legendre(int n);

// n >= 2 points, both ends among them; exact for polynomials of degree 2 n - 3.
Quadrature gauss_lobatto(int n);

// Of what bends at these points between two others: three points of gauss_legendre between each two of them,
// as shares of the way.
Quadrature gauss_between(const std::vector<double>& points, double from, double to);

}  // namespace unfurl
