// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// Rows of sums of coefficient * x[source], most of them of one term: the first terms of all rows in one pass
// and what there is behind them in another. A row is added up from zero in the order of its terms.
class RowSums {
 public:
  RowSums() = default;
  explicit RowSums(const SparseRows& A) {
    for (int r = 0; r < A.outerSize(); ++r) {
      begin_row();
      for (SparseRows::InnerIterator it(A, r); it; ++it) add(static_cast<int>(it.col()), it.value());
    }
  }
  void begin_row() {
    empty_.push_back(static_cast<int>(first_.size()));
    first_.push_back({0, 0.0});
  }
  void add(int source, double coefficient) {
    const int row = static_cast<int>(first_.size()) - 1;
    if (!empty_.empty() && empty_.back() == row) {
      first_.back() = {source, coefficient};
      empty_.pop_back();
    } else {
      further_.push_back({{source, coefficient}, row});
    }
  }

  // The same sums of magnitudes of coefficients.
  RowSums magnitudes() const {
    RowSums out = *this;
    for (Term& term : out.first_) term.coefficient = std::abs(term.coefficient);
    for (Further& f : out.further_) f.term.coefficient = std::abs(f.term.coefficient);
    return out;
  }

  void of(const double* x, double* out) const {
    const std::size_t rows = empty_.size() < first_.size() ? first_.size() : 0;  // else x may have no entry
#pragma GCC unroll 4
    for (std::size_t r = 0; r < rows; ++r) out[r] = 0.0 + first_[r].coefficient * x[first_[r].source];
    for (const Further& term : further_) out[term.row] += term.term.coefficient * x[term.term.source];
    for (const int r : empty_) out[r] = 0.0;
  }

 private:
  struct Term {
    std::ptrdiff_t source;
    double coefficient;
  };
  struct Further {
    Term term;
    std::ptrdiff_t row;
  };
  std::vector<Term> first_;
  std::vector<Further> further_;
  std::vector<int> empty_;
};

}  // namespace unfurl
