// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace unfurl {

// The angle about the edge from x_1 to x_2, from the half-plane of x_0 to that of x_3, right-handed about the
// edge, in (-pi, pi]. `stencil`: the coordinates of the four nodes; `gradient` takes 12 numbers, `hess` 144,
// column by column (nullptr: not wanted).
double dihedral(const double* q, const std::vector<int>& stencil, double* gradient, double* hess);

}  // namespace unfurl
