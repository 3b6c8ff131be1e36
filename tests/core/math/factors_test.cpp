// SPDX-License-Identifier: BSD-3-Clause
// Matrices without rows or columns, as of structures without constraints or without freedoms.
#include "core/math/factors.hpp"

#include <catch2/catch.hpp>
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
