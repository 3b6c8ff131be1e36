#include "core/math/linear_elimination.hpp"

#include <catch2/catch.hpp>

using namespace unfurl;

namespace linear_elimination_test {

namespace {

SparseRows rows(const MatrixXd& A) {
  SparseRows S = A.sparseView(1.0, 0.0);
  S.makeCompressed();
  return S;
}

}  // namespace

TEST_CASE("elimination spans exactly the solutions and names dependent rows") {
  MatrixXd A(5, 6);
  A << 1, 2, 0, 0, 0, 0,  //
      0, 1, -1, 0, 3, 0,  //
      1, 3, -1, 0, 3, 0,  // the sum of the first two
      0, 0, 0, 2, 0, 1,   //
      0, 0, 0, 4, 0, 2;   // twice the fourth, with another right-hand side
  VectorXd b(5);
  b << 1, 2, 3, 4, 9;
  const LinearElimination e = eliminate(rows(A), b);
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

}  // namespace linear_elimination_test
