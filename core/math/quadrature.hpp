// SPDX-License-Identifier: BSD-3-Clause
// Gauss quadrature on [0, 1], computed to round-off rather than tabulated.
#pragma once

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

}  // namespace unfurl
