// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/sparse_ldlt.hpp"

#include <catch2/catch.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace sparse_ldlt_test {

// The pivots of a dense matrix, one column after the other, every sum in the order of the columns.
VectorXd pivots_one_by_one(const MatrixXd& A) {
  const Index n = A.rows();
  MatrixXd L = MatrixXd::Zero(n, n);
  VectorXd pivot(n);
  for (Index k = 0; k < n; ++k) {
    VectorXd y = A.col(k).head(k);
    pivot[k] = A(k, k);
    for (Index i = 0; i < k; ++i) {
      for (Index j = i + 1; j < k; ++j) y[j] -= L(j, i) * y[i];
      L(k, i) = y[i] * (1.0 / pivot[i]);
      pivot[k] -= L(k, i) * y[i];
    }
  }
  return pivot;
}

// Columns of L that are alike are subtracted together, rows that follow each other by one instruction: of
// matrices that fill up, with gaps of all lengths between rows. Bit for bit, as no sum changes its order;
// what the sparse factors leave out are products with zero.
TEST_CASE("columns that are alike are eliminated together to the same bits as one by one") {
  unsigned state = 5u;
  const auto dice = [&state](int sides) {
    state = state * 1664525u + 1013904223u;
    return static_cast<int>((state >> 8) % static_cast<unsigned>(sides));
  };
  Index filled = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const int n = 4 + dice(60), negative = dice(n / 2);
    MatrixXd A = MatrixXd::Zero(n, n);
    for (int k = 0; k < n; ++k) A(k, k) = k < n - negative ? 4 + 0.1 * dice(50) : -1 - 0.1 * dice(50);
    for (int k = dice(4 * n); k >= 0; --k) {
      const int i = dice(n), j = dice(n);
      if (i != j) A(i, j) = A(j, i) = 0.01 * (dice(100) - 50);
    }
    if (trial % 3 == 0)  // a row that acts on all
      for (int k = 0; k + 1 < n; ++k) A(k, n - 1) = A(n - 1, k) = 0.02 * (dice(20) + 1);
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    for (int k = n - 1; k > 0; --k)
      std::swap(order[static_cast<std::size_t>(k)], order[static_cast<std::size_t>(dice(k + 1))]);
    const SparseRows upper = testing::sparse_rows(MatrixXd(A.triangularView<Eigen::Upper>()));
    SparseLdlt factors;
    factors.analyse(upper, order);
    INFO(trial << ": " << n << " rows");
    REQUIRE(factors.factorise(upper.valuePtr()));
    MatrixXd ordered(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        ordered(i, j) = A(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
    const VectorXd known = pivots_one_by_one(ordered);
    VectorXd ours(n);
    for (Index k = 0; k < n; ++k) ours[k] = factors.pivot(k);
    CHECK(ours == known);
    VectorXd x = VectorXd::LinSpaced(n, -1, 2);
    const VectorXd b = x;
    factors.solve(x.data(), 1);
    // No pivot is small, L stays of order 1: rounding of n products of numbers of order 1.
    CHECK((A * x - b).lpNorm<Eigen::Infinity>() < 1e-12);
    filled += factors.factor_nonzeros();
  }
  CHECK(filled > 10000);  // or hardly any column was like another one
}

}  // namespace sparse_ldlt_test
