// SPDX-License-Identifier: BSD-3-Clause
// Which rows of a sparse matrix follow from the rows before them.
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

struct RowDependence {
  std::vector<int> rows;  // those that do, in rising order
  double least = 1;       // the smallest part that others left of a row's largest entry, of rows that do not
  Index entries = 0;      // of all rows that were solved: the fill
};

// Gaussian elimination of the rows in their order, as eliminate() does it, but rows that were solved stay as
// they are when later ones are: a row is cleared of their coordinates one after the other, in the order in
// which they were solved. What is left of a row is the same, without B, which is full where a mechanism of
// many parts has few ways to move.
RowDependence dependence_of_rows(const SparseRows& A, double tolerance);

}  // namespace unfurl
