// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/linear_elimination.hpp"
#include "core/math/factors.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace linear_elimination_test {

using testing::sparse_rows;

TEST_CASE("elimination spans exactly the solutions and names dependent rows") {
  MatrixXd A(5, 6);
  A << 1, 2, 0, 0, 0, 0,  //
      0, 1, -1, 0, 3, 0,  //
      1, 3, -1, 0, 3, 0,  // the sum of the first two
      0, 0, 0, 2, 0, 1,   //
      0, 0, 0, 4, 0, 2;   // twice the fourth, with another right-hand side
  VectorXd b(5);
  b << 1, 2, 3, 4, 9;
  const LinearElimination e = eliminate(sparse_rows(A), b);
  CHECK(e.redundant == std::vector<int>{2});
  CHECK(e.inconsistent == std::vector<int>{4});
  REQUIRE(e.B.cols() == 3);
  const MatrixXd kept = A.topRows(4);
  CHECK((kept * MatrixXd(e.B)).cwiseAbs().maxCoeff() <= 1e-15);  // small integers: exact up to a rounding
  CHECK((kept * e.q0 - b.head(4)).cwiseAbs().maxCoeff() <= 1e-15);
  for (Index i = 0; i < 3; ++i)
    CHECK(MatrixXd(e.B)
              .row(e.free_coordinates[static_cast<std::size_t>(i)])
              .isApprox(VectorXd::Unit(3, i).transpose()));
}

TEST_CASE(
    "elimination keeps rows that would make one coordinate act on many, but not for coordinates that must "
    "go") {
  // x_0 = x_1 = ... = x_9 and y = (x_0 + x_9) / 2: solved throughout, one coordinate acts on all others.
  const int n = 10;
  MatrixXd A = MatrixXd::Zero(n, n + 1);
  for (int i = 0; i + 1 < n; ++i) A(i, i) = 1, A(i, i + 1) = -1;
  A(n - 1, 0) = A(n - 1, n - 1) = 0.5;
  A(n - 1, n) = -1;
  const VectorXd b = VectorXd::Zero(n);
  std::vector<char> must(n + 1, 0);
  must[n] = 1;
  const LinearElimination all = eliminate(sparse_rows(A), b),
                          some = eliminate_sparsely(sparse_rows(A), b, must, 3);
  CHECK(all.B.cols() == 1);
  CHECK(all.kept.empty());
  CHECK(!some.kept.empty());
  CHECK(std::find(some.kept.begin(), some.kept.end(), n - 1) == some.kept.end());
  CHECK(std::find(some.free_coordinates.begin(), some.free_coordinates.end(), n) ==
        some.free_coordinates.end());
  const MatrixXd B = some.B;
  for (Index c = 0; c < B.cols(); ++c) CHECK((B.col(c).array() != 0).count() <= 1 + 3);
  // Halves and ones: exact. What is solved is fulfilled; with the rows kept, one freedom is left as in `all`.
  MatrixXd kept(static_cast<Index>(some.kept.size()), B.cols());
  for (int r = 0; r < n; ++r) {
    const auto at = std::find(some.kept.begin(), some.kept.end(), r);
    if (at == some.kept.end())
      CHECK((A.row(r) * B).cwiseAbs().maxCoeff() == 0.0);
    else
      kept.row(at - some.kept.begin()) = A.row(r) * B;
  }
  CHECK(rank_of(kept) == B.cols() - 1);
}

TEST_CASE("rows are solved alike at any scale, few entries or many") {
  MatrixXd A = MatrixXd::Zero(3, 12);
  A.row(0).head(9).setConstant(1);  // each a third of the row's length
  A.row(0)[4] = -1.1;
  A.row(1).segment(5, 3) << 3, 1, -2;
  A.row(2).tail(4) << 2, 5, 1, 7;
  VectorXd b(3);
  b << 0.3, -1.7, 2.9;
  const LinearElimination one = eliminate(sparse_rows(A), b);
  REQUIRE(one.B.cols() == 9);
  for (const double scale : {1e-7, 0.013, 170.0, 3e8}) {
    INFO(scale);
    const LinearElimination e = eliminate(sparse_rows(scale * A), scale * b);
    CHECK(e.kept.empty());
    CHECK(e.free_coordinates == one.free_coordinates);
    CHECK((A * e.q0 - b).cwiseAbs().maxCoeff() <= 1e-14);  // a few roundings
    CHECK((A * MatrixXd(e.B)).cwiseAbs().maxCoeff() <= 1e-14);
  }
  // Threshold pivoting: no coordinate is solved for by less than half of its row's largest entry.
  CHECK(MatrixXd(one.B).cwiseAbs().maxCoeff() <= 3.5 + 1e-14);
}

// x_0 = x_1 + ... goes by x_0, and x_1 is held by it. A row of x_1 and c x_2 goes by x_2, which nothing
// holds, if c is at least half of what x_1 has, else by x_1. A coordinate that must go is solved for by any
// entry.
TEST_CASE("a row is solved for what the fewest rows hold of its large entries") {
  for (const double c : {0.6, -0.6, 0.4, -0.4})
    for (const bool must_go : {false, true}) {
      INFO(c << (must_go ? ", must go" : ""));
      MatrixXd A(2, 3);
      A << 2, -1, 0, 0, 1, c;
      const Vec3 b(0.7, -1.3, 0);
      const std::vector<char> must{0, 0, static_cast<char>(must_go ? 1 : 0)};
      const LinearElimination e = eliminate_sparsely(sparse_rows(A), b.head<2>(), must, 100);
      const bool by_third = must_go || std::abs(c) > 0.5;
      CHECK(e.free_coordinates == std::vector<int>{by_third ? 1 : 2});
      CHECK((A * e.q0 - b.head<2>()).norm() < 1e-15);
      CHECK((A * MatrixXd(e.B)).norm() < 1e-15);
    }
}

}  // namespace linear_elimination_test
