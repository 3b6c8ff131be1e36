// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/row_sums.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace row_sums_test {

using testing::sparse_rows;

// Every row is added up from zero in the order of its terms, so to the same bits as by a loop over them.
TEST_CASE("sums of rows are those of a matrix times a vector, to the bit, empty rows included") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const int columns : {1, 7}) {
    MatrixXd dense = MatrixXd::Zero(23, columns);
    for (int r = 0; r < dense.rows(); ++r)
      for (int k = r % 5; k > 0; --k)
        dense(r, static_cast<int>(random() % static_cast<unsigned>(columns))) = uniform(random);
    const SparseRows A = sparse_rows(dense);
    VectorXd x(columns), out(dense.rows());
    for (double& value : x) value = uniform(random);
    RowSums(A).of(x.data(), out.data());
    for (int r = 0; r < A.rows(); ++r) {
      double sum = 0;
      for (SparseRows::InnerIterator it(A, r); it; ++it) sum += it.value() * x[it.col()];
      CHECK(out[r] == sum);
    }
  }
}

TEST_CASE("sums of rows without any term are zero, and ask for no number") {
  VectorXd out = VectorXd::Ones(4);
  RowSums(SparseRows(4, 0)).of(nullptr, out.data());
  CHECK(out.isZero(0));
}

}  // namespace row_sums_test
