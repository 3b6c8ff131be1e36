// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/singular_values.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/math/types.hpp"

using namespace unfurl;

TEST_CASE("singular values of a bidiagonal matrix by iteration and by bisection agree with the closed form") {
  for (const Index n : {1, 2, 7, 40}) {
    // c on the diagonal and beside it: B^T B is c^2 times tridiagonal (1, 2, 1) with 1 in the first corner,
    // whose eigenvalues are 4 cos^2(k pi / (2 n + 1)), k = 1..n.
    const double c = 0.37;
    const VectorXd entries = VectorXd::Constant(2 * n - 1, c);
    for (const bool by_bisection : {false, true}) {
      const VectorXd values = singular_values_of_bidiagonal(entries, by_bisection);
      REQUIRE(values.size() == n);
      for (Index k = 0; k < n; ++k)
        // Round-off of n rotations or 50 halvings, relative to the largest.
        CHECK(values[k] ==
              Approx(2 * c * std::cos(static_cast<double>(k + 1) * pi / static_cast<double>(2 * n + 1)))
                  .margin(1e-15 * static_cast<double>(n)));
    }
    // A few of them, in any order, and between which ones a number lies.
    std::vector<Index> which;
    for (Index k = 0; k < n; ++k) which.push_back((3 * k + 1) % n);
    const VectorXd some = singular_values_at(entries, which);
    const VectorXd all = singular_values_of_bidiagonal(entries, true);
    REQUIRE(some.size() == n);
    for (Index k = 0; k < n; ++k) {
      const Index i = which[static_cast<std::size_t>(k)];
      CHECK(some[k] == Approx(all[i]).epsilon(0).margin(1e-15 * static_cast<double>(n)));
      CHECK(singular_values_above(entries, 0.999 * all[i]) == i + 1);
      CHECK(singular_values_above(entries, 1.001 * all[i]) == i);
    }
  }
}

TEST_CASE("singular values by bisection find zeros and clusters") {
  VectorXd entries = VectorXd::Zero(11);
  for (const Index i : {0, 2, 6, 8}) entries[i] = 0.73;  // diagonal (0.73, 0.73, 0, 0.73, 0.73, 0)
  const VectorXd values = singular_values_of_bidiagonal(entries, true);
  for (Index k = 0; k < 4; ++k) CHECK(values[k] == Approx(0.73).epsilon(1e-15));
  CHECK(values[4] == 0.0);
  CHECK(values[5] == 0.0);
  const Index which[] = {5, 0, 4, 3, 1};
  const VectorXd some = singular_values_at(entries, which);
  for (const Index k : {1, 3, 4}) CHECK(some[k] == Approx(0.73).epsilon(1e-15));
  CHECK(some[0] == 0.0);
  CHECK(some[2] == 0.0);
  CHECK(singular_values_above(entries, 1e-12) == 4);
}

TEST_CASE("singular values of a matrix that is not finite are not numbers") {
  MatrixXd A = MatrixXd::Identity(3, 4);
  A(1, 2) = std::numeric_limits<double>::infinity();
  CHECK(singular_values(A).array().isNaN().all());
}

TEST_CASE("singular values do not depend on signs, and keep the sums of their powers") {
  VectorXd entries(9);
  entries << 0.7, -1.9, -0.4, 1.3, -2.1, -0.6, 0.9, -1.1, 0.2;
  for (const bool by_bisection : {false, true}) {
    const VectorXd values = singular_values_of_bidiagonal(entries, by_bisection);
    const VectorXd same = singular_values_of_bidiagonal(entries.cwiseAbs(), by_bisection);
    CHECK((values - same).cwiseAbs().maxCoeff() <= 1e-14);
    CHECK((values - singular_values_of_bidiagonal(-entries.cwiseAbs(), by_bisection)).cwiseAbs().maxCoeff() <=
          1e-14);
    CHECK(values.squaredNorm() == Approx(entries.squaredNorm()).epsilon(1e-14));
  }
  for (const auto& [rows, columns] : {std::pair{5, 8}, {8, 5}, {6, 6}}) {
    MatrixXd A(rows, columns);
    for (Index i = 0; i < A.rows(); ++i)
      for (Index k = 0; k < A.cols(); ++k) A(i, k) = std::sin(3.7 * double(i) - 1.3 * double(k * k) + 0.4);
    const VectorXd values = singular_values(A);
    REQUIRE(values.size() == std::min(rows, columns));
    // Traces of A^T A and its powers.
    const MatrixXd S = A.transpose() * A;
    CHECK(values.array().pow(2).sum() == Approx(S.trace()).epsilon(1e-13));
    CHECK(values.array().pow(4).sum() == Approx((S * S).trace()).epsilon(1e-13));
    CHECK(values.array().pow(6).sum() == Approx((S * S * S).trace()).epsilon(1e-13));
    for (Index k = 1; k < values.size(); ++k) CHECK(values[k] <= values[k - 1]);
  }
}

TEST_CASE("a matrix that is not finite has as many singular values as any other of its shape, none known") {
  for (const Index rows : {2, 3, 5}) {
    MatrixXd matrix = MatrixXd::Ones(rows, 3);
    CHECK(singular_values(matrix).size() == std::min<Index>(rows, 3));
    matrix(1, 1) = std::nan("");
    const VectorXd values = singular_values(matrix);
    REQUIRE(values.size() == std::min<Index>(rows, 3));
    for (const double value : values) CHECK(std::isnan(value));
  }
}

// Reflections leave singular values as they are: known ones on a diagonal, tall and wide.
TEST_CASE("ranks are counts of the singular values that a matrix was made of") {
  const auto reflection = [](Index n) {
    VectorXd x(n);
    for (Index i = 0; i < n; ++i) x[i] = 1.3 + std::sin(double(i * i));
    return MatrixXd(MatrixXd::Identity(n, n) - 2.0 / x.squaredNorm() * x * x.transpose());
  };
  for (const auto& [rows, columns] : {std::pair<Index, Index>{6, 4}, {4, 6}, {5, 5}}) {
    MatrixXd middle = MatrixXd::Zero(rows, columns);
    middle.diagonal().head(4) << 20, 3, 1e-6, 0;
    const MatrixXd A = reflection(rows) * middle * reflection(columns);
    CHECK(rank_above(A, 5) == 1);
    CHECK(rank_above(A, 1e-3) == 2);
    CHECK(rank_above(A, 1e-12) == 3);  // round-off of 20 is 1e-15
    CHECK(rank_within(A, 0.2) == 1);
    CHECK(rank_within(A, 1e-7) == 2);  // of 20: 1e-6 is 5e-8
    CHECK(rank_within(A, 1e-8) == 3);
    CHECK(rank_within(MatrixXd::Zero(rows, columns), 1e-11) == 0);
    CHECK(rank_within(MatrixXd::Constant(rows, columns, std::nan("")), 1e-11) == 0);
    CHECK(rank_above(MatrixXd::Constant(rows, columns, std::nan("")), 1e-11) == 0);
  }
  CHECK(rank_above(MatrixXd(0, 3), 1e-11) == 0);
  CHECK(rank_within(MatrixXd(3, 0), 1e-11) == 0);
}
