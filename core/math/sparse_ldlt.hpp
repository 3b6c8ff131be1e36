// SPDX-License-Identifier: BSD-3-Clause
// Sparse L D L^T of a symmetric quasi-definite matrix, in a fixed order without pivoting.
//
// A quasi-definite matrix [A G^T; G -C] with A, C positive definite has L D L^T in every order (Vanderbei
// 1995, SIAM J. Optim. 5). The pattern is analysed once; a numeric factorisation and a solve allocate
// nothing.
#pragma once

#include <limits>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

class SparseLdlt {
 public:
  // upper: pattern of the upper triangle with the diagonal, as the rows of a symmetric matrix (row <=
  // column). order[k]: which row is eliminated k-th.
  void analyse(const SparseRows& upper, const std::vector<int>& order);

  // values: as the nonzeros of `upper` in their storage order. A pivot that round-off brought nearer to zero
  // than C allows is that of C. False where a pivot is zero, not finite, or `most` or more.
  [[nodiscard]] bool factorise(const double* values, double most = std::numeric_limits<double>::infinity());

  // Solve for `columns` right-hand sides held row by row: x[row * columns + c], in place, in the caller's row
  // order.
  void solve(double* x, int columns) const;

  // The same for right-hand sides whose rows are in the order of elimination already.
  void solve_ordered(double* b, int columns) const;
  // r -= A x for the matrix with these values (as for factorise); rows in the order of elimination.
  void subtract_product(const double* values, const double* x, double* r) const;
  const std::vector<int>& order() const { return order_; }  // as given to analyse

  Index size() const { return n_; }
  Index factor_nonzeros() const { return static_cast<Index>(row_index_.size()); }
  double largest_pivot() const;
  double pivot(Index k) const { return pivot_[static_cast<std::size_t>(k)]; }  // of the row eliminated k-th
  // What the k-th pivot falls by where the diagonal of all rows whose pivots are negative falls by a small 1:
  // the squares of the combination of rows that is left in it, u of L^T u = e_k.
  double pivot_rate(std::size_t k) const {
    return pivot_rate(
        k, [this](std::size_t p) { return l_[p]; }, [this](std::size_t j) { return pivot_[j] < 0; });
  }

 private:
  friend class TwofoldLdlt;
  friend class SaddleLanes;
  template <int width>
  bool eliminate(const double* values, double most);
  template <int R>
  void solve_fixed(double* b) const;
  template <class Factor, class Falls>
  double pivot_rate(std::size_t k, Factor l, Falls falls) const {
    std::vector<double> u(k + 1, 0.0);
    u[k] = 1.0;
    double rate = falls(k) ? 1.0 : 0.0;
    for (std::size_t j = k; j-- > 0;) {
      for (auto p = static_cast<std::size_t>(column_start_[j]),
                end = static_cast<std::size_t>(column_start_[j + 1]);
           p < end; ++p)
        if (const auto row = static_cast<std::size_t>(row_index_[p]); row <= k) u[j] -= l(p) * u[row];
      if (falls(j)) rate += u[j] * u[j];
    }
    return rate;
  }

  Index n_ = 0;
  std::vector<int> order_;         // position -> row
  std::vector<int> column_start_;  // of L, by columns, unit diagonal left out
  std::vector<int> row_index_;
  std::vector<double> l_;
  std::vector<double> pivot_, inverse_pivot_;
  std::vector<int> reach_start_, reach_;       // row k of L: its columns in elimination order
  std::vector<int> slot_;                      // where its entries are in l_
  std::vector<int> entry_start_;               // column k of the permuted upper triangle
  std::vector<int> entry_row_, entry_source_;  // its rows and where their values come from
  std::vector<double> work_;
  mutable std::vector<double> permuted_;
};

}  // namespace unfurl
