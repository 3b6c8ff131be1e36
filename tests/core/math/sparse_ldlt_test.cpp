// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/sparse_ldlt.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/math/twofold.hpp"
#include "core/math/twofold_ldlt.hpp"
#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace sparse_ldlt_test {

double inverse(double x) {
  return 1.0 / x;
}
double leading(double x) {
  return x;
}
double leading(const Twofold& x) {
  return x.hi;
}

// The pivots of a dense matrix, one column after the other, every sum in the order of the columns.
template <class Number>
VectorXd pivots_one_by_one(const MatrixXd& A) {
  const auto n = static_cast<std::size_t>(A.rows());
  std::vector<std::vector<Number>> L(n, std::vector<Number>(n, Number(0.0)));
  std::vector<Number> pivot(n), y(n);
  VectorXd out(A.rows());
  for (std::size_t k = 0; k < n; ++k) {
    const auto entry = [&A, k](std::size_t i) { return A(static_cast<Index>(i), static_cast<Index>(k)); };
    for (std::size_t i = 0; i < k; ++i) y[i] = entry(i);
    pivot[k] = entry(k);
    for (std::size_t i = 0; i < k; ++i) {
      for (std::size_t j = i + 1; j < k; ++j) y[j] = y[j] - L[j][i] * y[i];
      L[k][i] = y[i] * inverse(pivot[i]);
      pivot[k] = pivot[k] - L[k][i] * y[i];
    }
    out[static_cast<Index>(k)] = leading(pivot[k]);
  }
  return out;
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
    VectorXd ours(n);
    for (Index k = 0; k < n; ++k) ours[k] = factors.pivot(k);
    CHECK(ours == pivots_one_by_one<double>(ordered));
    VectorXd x = VectorXd::LinSpaced(n, -1, 2);
    const VectorXd b = x;
    factors.solve(x.data(), 1);
    // No pivot is small, L stays of order 1: rounding of n products of numbers of order 1.
    CHECK((A * x - b).lpNorm<Eigen::Infinity>() < 1e-12);
    TwofoldLdlt twofold(factors);
    const std::vector<double> shift(static_cast<std::size_t>(n), 0.0);
    REQUIRE(twofold.factorise(upper.valuePtr(), shift.data()));
    for (Index k = 0; k < n; ++k) ours[k] = twofold.pivot(k);
    CHECK(ours == pivots_one_by_one<Twofold>(ordered));
    std::vector<Twofold> right(b.begin(), b.end()), root(right);
    twofold.solve_ordered(root.data());
    twofold.subtract_product(upper.valuePtr(), root.data(), right.data());
    double left = 0;
    for (const Twofold& r : right) left = std::max(left, std::abs(r.hi));
    CHECK(left < 1e-28);  // the same rounding in twice the digits
    filled += factors.factor_nonzeros();
  }
  CHECK(filled > 10000);  // or hardly any column was like another one
}

}  // namespace sparse_ldlt_test
