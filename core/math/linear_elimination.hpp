// SPDX-License-Identifier: BSD-3-Clause
// Exact elimination of sparse linear constraints A q = b: q = q_0 + B z.
#pragma once

#include <string>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

struct LinearElimination {
  SparseRows B;                       // [3n x nz]; each row of a free coordinate is a unit row
  VectorXd q0;                        // [3n]
  std::vector<int> free_coordinates;  // which entries of q are the entries of z
  std::vector<int> redundant;         // rows of A that follow from the others (consistent)
  std::vector<int> inconsistent;      // rows of A that contradict the others
  std::vector<int> kept;  // rows of A that were left as equations: q = q_0 + B z does not fulfil them
  double least = 1;  // the smallest part that others left of a row's largest entry, of rows not redundant
};

// Gaussian elimination; a row whose entries all fall below tolerance * its original norm is dependent. Each
// reduced row is solved for the coordinate that the fewest earlier rows hold, of those within half of its
// largest entry (threshold pivoting, Markowitz 1957): chains of relations then stay short sums.
// Where the rows solved so far nearly depend on each other, round-off in what is left of a dependent row
// grows beyond that: `least` says so.
LinearElimination eliminate(const SparseRows& A, const ConstVec& b, double tolerance = 1e-11);

// The same, but rows are kept where solving them would let one free coordinate act on more than `limit`
// others. Coordinates marked in `must` are solved for in any case (empty: none).
LinearElimination eliminate_sparsely(const SparseRows& A, const ConstVec& b, const std::vector<char>& must,
                                     Index limit, double tolerance = 1e-11);

}  // namespace unfurl
