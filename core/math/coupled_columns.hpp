// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// Sets of columns of which no row has entries in two.
class CoupledColumns {
 public:
  explicit CoupledColumns(Index columns) : parent_(static_cast<std::size_t>(columns)) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index size() const { return std::ssize(parent_); }
  void join_rows_of(const SparseRows& A) {
    for (int r = 0; r < A.outerSize(); ++r) {
      const Index first = SparseRows::InnerIterator(A, r) ? set_of(SparseRows::InnerIterator(A, r).col()) : 0;
      for (SparseRows::InnerIterator it(A, r); it; ++it) parent(set_of(it.col())) = first;
    }
  }
  Index set_of(Index column) {  // one of its columns
    while (parent(column) != column) column = parent(column) = parent(parent(column));
    return column;
  }

 private:
  Index& parent(Index column) { return parent_[static_cast<std::size_t>(column)]; }
  std::vector<Index> parent_;
};

}  // namespace unfurl
