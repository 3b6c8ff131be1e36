// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

/// Which entries of y are determined by G^T y = f [1: yes], for every right-hand side that has a solution.
///
/// Entry i is determined if and only if row i of a basis of null(G^T) is zero, that is if the rank falls when
/// row i of G is removed (Wojtyra and Fraczek, Multibody Syst. Dyn. 30 (2013) 153). The basis is not formed:
/// a vector r without structure is projected on the null space, w = r - G x with G^T w = 0, which is the
/// saddle-point system [I G; G^T 0] [w; x] = [r; 0]. Each w_i is then a random multiple of the norm of row i
/// of the basis, and a few such vectors tell zero from not zero. One sparse factorisation, any size.
///
/// Rows of G may have any scale; directions whose singular value is below some 1e-6 of that of unit rows
/// count as lost, entries below 1e-9 as round-off, which is what coordinates have of poses without rank. A
/// row of zeros is not determined.
///
/// With `compliance` y has in addition the least energy 1/2 sum compliance_i y_i^2 (least_energy.hpp). Two
/// such y differ by a vector of null(G^T) without energy, which vanishes where compliance_i > 0: those
/// entries are determined, and of the others those that the rows without compliance determine among
/// themselves.
std::vector<char> determined_rows(const SparseRows& G, const VectorXd& compliance = {});

/// Which entries of told^T y, `told` with as many rows as G, are determined by the same equations [one a
/// column of told, 1: yes]: what one choice of y takes from a row it may give to another one.
std::vector<char> determined_sums(const SparseRows& G, const SparseRows& told,
                                  const VectorXd& compliance = {});

/// G^T without the entries of round-off, below that share of their rows of G: solvers scale coordinates to
/// one size and would take them for slopes. G is not changed but for those.
SparseRows without_round_off_transposed(const SparseRows& G, double round_off = 1e-11);

}  // namespace unfurl
