// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace unfurl {

// The angle about the edge from x_1 to x_2, from the half-plane of x_0 to that of x_3, right-handed about the
// edge, in (-pi, pi]. `stencil`: the coordinates of the four nodes; `gradient` takes 12 numbers.
double dihedral(const double* q, const std::vector<int>& stencil, double* gradient);
// Its second derivatives: 144 numbers, column by column.
void dihedral_hessian(const double* q, const std::vector<int>& stencil, double* hess);
// v^T Hess v: its second derivative along q + t v, without that matrix.
double dihedral_curvature(const double* q, const double* v, const std::vector<int>& stencil);
// By what it changes from q to q + u, to the nearest turn; round-off is relative to u.
double dihedral_change(const double* q, const double* u, const std::vector<int>& stencil);

}  // namespace unfurl
