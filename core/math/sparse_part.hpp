// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// Some columns of a sparse matrix, and the rows that have entries in any of them.
class SparsePart {
 public:
  SparsePart(const SparseRows& A, std::vector<Index> columns)
      : columns_(std::move(columns)), place_(static_cast<std::size_t>(A.cols()), -1) {
    for (std::size_t k = 0; k < columns_.size(); ++k)
      place_[static_cast<std::size_t>(columns_[k])] = static_cast<Index>(k);
    for (int r = 0; r < A.outerSize(); ++r)
      for (SparseRows::InnerIterator it(A, r); it; ++it)
        if (place_[static_cast<std::size_t>(it.col())] >= 0) {
          rows_.push_back(r);
          break;
        }
  }

  const std::vector<Index>& columns() const { return columns_; }
  const std::vector<int>& rows() const { return rows_; }

  SparseRows of(const SparseRows& A) const { return among(A, rows_); }
  // Of a square matrix the same rows as columns.
  SparseRows of_square(const SparseRows& A) const {
    return among(A, std::vector<int>(columns_.begin(), columns_.end()));
  }

 private:
  SparseRows among(const SparseRows& A, const std::vector<int>& rows) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (SparseRows::InnerIterator it(A, rows[k]); it; ++it)
        if (const Index column = place_[static_cast<std::size_t>(it.col())]; column >= 0)
          entries.emplace_back(static_cast<int>(k), static_cast<int>(column), it.value());
    SparseRows out(std::ssize(rows), std::ssize(columns_));
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  std::vector<Index> columns_, place_;  // place_: of each column of A among them; -1: it is none
  std::vector<int> rows_;
};

}  // namespace unfurl
