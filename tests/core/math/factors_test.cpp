// SPDX-License-Identifier: BSD-3-Clause
// Matrices without rows or columns, as of structures without constraints or without freedoms.
#include "core/math/factors.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

using namespace unfurl;

TEST_CASE("factors of matrices without rows or columns are those of nothing") {
  CHECK(symmetric_eigen(MatrixXd(0, 0)).values.size() == 0);
  CHECK(symmetric_eigenvalues(MatrixXd(0, 0)).size() == 0);
  CHECK(complex_eigen(MatrixXd(0, 0)).inverse.size() == 0);
  CHECK(inverse_of(MatrixXd(0, 0)).size() == 0);
  for (const auto& [rows, columns] : {std::pair{0, 0}, {0, 3}, {4, 0}}) {
    INFO(rows << " x " << columns);
    const MatrixXd A(rows, columns);
    CHECK(least_squares(A, VectorXd::Ones(rows)) == VectorXd::Zero(columns));
    CHECK(fitted_columns(A, MatrixXd::Ones(rows, 2)) == MatrixXd::Zero(columns, 2));
    CHECK(rank_of(A) == 0);
    CHECK(column_space(A, 1e-12).rows() == rows);
    CHECK(column_space(A, 1e-12).cols() == 0);
    CHECK(column_complement(A, 1e-12) == MatrixXd::Identity(rows, rows));
    CHECK(orthonormal_columns(A).rows() == rows);
    CHECK(orthonormal_columns(A).cols() == columns);
  }
  CHECK(Cholesky(MatrixXd(0, 0)).solve(VectorXd(0)).size() == 0);
}

// 2 x 2: (a + d) / 2 -+ sqrt((a - d)^2 / 4 + b^2).
TEST_CASE("eigenvalues of symmetric matrices are the closed form and ascend with vectors or without") {
  const double a = 1.7, b = -0.6, d = 0.4, middle = (a + d) / 2, off = std::hypot((a - d) / 2, b);
  MatrixXd A(2, 2);
  A << a, b, b, d;
  const VectorXd alone = symmetric_eigenvalues(A);
  const SymmetricEigen both = symmetric_eigen(A);
  for (const VectorXd& values : {alone, both.values}) {
    CHECK(values[0] == Approx(middle - off).epsilon(1e-14));
    CHECK(values[1] == Approx(middle + off).epsilon(1e-14));
  }
  CHECK((A * both.vectors - both.vectors * both.values.asDiagonal()).norm() < 1e-15 * 4);
}

TEST_CASE("a rank goes by the share of the largest that counts") {
  MatrixXd A = MatrixXd::Zero(3, 4);
  A.diagonal() << 2.3, 1e-6, 1e-12;
  CHECK(rank_of(A) == 3);
  CHECK(rank_of(A, 1e-9) == 2);
  CHECK(rank_of(A, 1e-4) == 1);
}
