// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/least_energy.hpp"
#include "core/math/factors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/math/determined_rows.hpp"
#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace least_energy_test {

using testing::sparse_rows;

namespace {

struct Truss {
  MatrixXd G;
  VectorXd compliance, y;
};

// Rods between random nodes in space, some there twice, some rigid, coordinates held by guides of any length
// of row, some of them twice; forces of any size.
Truss random_truss(std::mt19937& random, double decades = 1.0) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const int nodes = 3 + any(4), rods = 4 + any(3 * nodes), guides = 2 + any(8);
  MatrixXd x(3, nodes);
  for (Index i = 0; i < x.size(); ++i) x.data()[i] = uniform(random);
  Truss t{MatrixXd::Zero(rods + guides, 3 * nodes), VectorXd::Zero(rods + guides), VectorXd(rods + guides)};
  for (int r = 0; r < rods; ++r) {
    const int a = any(nodes), b = (a + 1 + any(nodes - 1)) % nodes;
    const Vec3 d = (x.col(b) - x.col(a)).normalized();
    t.G.block<1, 3>(r, 3 * a) = -d.transpose();
    t.G.block<1, 3>(r, 3 * b) = d.transpose();
    if (any(5) > 0) t.compliance[r] = std::pow(10.0, -8.0 + decades * uniform(random));
  }
  t.compliance[0] = 2.3e-8;
  for (int h = 0; h < guides; ++h) t.G(rods + h, any(3 * nodes)) = 1.5 + uniform(random);
  for (Index i = 0; i < t.y.size(); ++i) t.y[i] = 300 * uniform(random);
  return t;
}

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using LongFactors = Eigen::FullPivHouseholderQR<LongMatrix>;  // unblocked: half the time to compile

struct Spaces {  // orthonormal
  LongMatrix of_rows, null;
};

Spaces spaces(const LongMatrix& A) {
  LongFactors factors(A.cols(), A.rows());
  factors.setThreshold(1e-9L).compute(A.transpose());
  const LongMatrix all = factors.matrixQ();
  return {all.leftCols(factors.rank()), all.rightCols(A.cols() - factors.rank())};
}

MatrixXd null_space(const MatrixXd& A) {
  return spaces(A.cast<long double>()).null.cast<double>();
}

// y + N a of least energy: N^T C N a = -N^T C y, a = 0 in directions in which only guides take part.
VectorXd by_definition(const Truss& t) {
  const MatrixXd N = null_space(t.G.transpose());
  if (N.cols() == 0) return t.y;
  const VectorXd c = t.compliance / t.compliance.maxCoeff();
  const MatrixXd CN = c.asDiagonal() * N;
  const SymmetricEigen energy = symmetric_eigen(N.transpose() * CN);
  const VectorXd slope = energy.vectors.transpose() * VectorXd(CN.transpose() * t.y);
  VectorXd a = VectorXd::Zero(N.cols());
  for (Index k = 0; k < a.size(); ++k)
    if (energy.values[k] > 1e-10) a[k] = -slope[k] / energy.values[k];
  return t.y + N * VectorXd(energy.vectors * a);
}

// The same where compliances differ by any factor: least squares of sqrt(c_i) (y + N V a)_i, the softest
// members first, V: the directions in which members take part.
VectorXd by_long_least_squares(const Truss& t) {
  const LongMatrix N = spaces(t.G.transpose().cast<long double>()).null;
  std::vector<Index> members;
  for (Index i = 0; i < t.y.size(); ++i)
    if (t.compliance[i] > 0) members.push_back(i);
  std::sort(members.begin(), members.end(),
            [&](Index a, Index b) { return t.compliance[a] > t.compliance[b]; });
  if (N.cols() == 0) return t.y;
  LongMatrix A(std::ssize(members), N.cols());
  LongVector b(std::ssize(members));
  for (Index k = 0; k < A.rows(); ++k) A.row(k) = N.row(members[static_cast<std::size_t>(k)]);
  if (A.cwiseAbs().maxCoeff() < 1e-9L) return t.y;  // guides alone
  const LongMatrix V = spaces(A).of_rows;
  LongMatrix B = A * V;
  for (Index k = 0; k < A.rows(); ++k) {
    const Index i = members[static_cast<std::size_t>(k)];
    const long double root = std::sqrt(static_cast<long double>(t.compliance[i]));
    B.row(k) *= root;
    b[k] = -root * static_cast<long double>(t.y[i]);
  }
  LongFactors factors(B.rows(), B.cols());
  factors.setThreshold(0).compute(B);
  return (t.y.cast<long double>() + N * (V * LongVector(factors.solve(b)))).cast<double>();
}

}  // namespace

TEST_CASE("the forces of least energy are those that the null space gives: 500 random trusses") {
  std::mt19937 random(77);
  double off = 0, unbalanced = 0;
  int shared = 0, open = 0;
  for (int k = 0; k < 500; ++k) {
    const Truss t = random_truss(random);
    const SparseRows G = sparse_rows(t.G);
    const VectorXd wanted = by_definition(t);
    VectorXd y = t.y;
    REQUIRE(LeastEnergy(G, t.compliance).share(G, y));
    const std::vector<char> determined = determined_rows(G, t.compliance);
    for (Index i = 0; i < y.size(); ++i) {
      if (determined[static_cast<std::size_t>(i)]) off = std::max(off, std::abs(y[i] - wanted[i]));
      open += !determined[static_cast<std::size_t>(i)];
      shared += std::abs(wanted[i] - t.y[i]) > 1.0;
    }
    unbalanced = std::max(unbalanced, (t.G.transpose() * (y - t.y)).lpNorm<Eigen::Infinity>());
  }
  // Forces of 300 N. L D L^T squares singular values, of which weak frames have 1e-2 and compliances that
  // differ by a hundred make 1e-3: round-off of 1e-16 / 1e-6 of them.
  CHECK(off < 3e-7);
  CHECK(unbalanced < 3e-8);
  CHECK(shared > 1000);
  CHECK(open > 50);
}

TEST_CASE("members share alike however soft others are: 600 random trusses up to ten decades wide") {
  std::mt19937 random(79);
  for (const double decades : {2.0, 3.0, 4.0, 5.0}) {
    int wrong = 0, shared = 0;
    for (int k = 0; k < 150; ++k) {
      const Truss t = random_truss(random, decades);
      const SparseRows G = sparse_rows(t.G);
      const VectorXd wanted = by_long_least_squares(t);
      VectorXd y = t.y;
      double off = 0;
      const bool found = LeastEnergy(G, t.compliance).share(G, y);
      const std::vector<char> determined = determined_rows(G, t.compliance);
      for (Index i = 0; i < y.size(); ++i) {
        if (determined[static_cast<std::size_t>(i)]) off = std::max(off, std::abs(y[i] - wanted[i]));
        shared += std::abs(wanted[i] - t.y[i]) > 1.0;
      }
      wrong += !found || off > 0.03;
      const VectorXd unbalanced = t.G.transpose() * (y - t.y);
      wrong += unbalanced.lpNorm<Eigen::Infinity>() > 0.03;
    }
    CAPTURE(decades);
    // Forces of 300 N, to a ten-thousandth of them. Round-off as above; singular values are down to the root
    // of a tenth of the smallest compliance over the largest, which with those of a weak frame, one in some
    // hundreds, is beyond all digits.
    CHECK(wrong <= 2);
    CHECK(shared > 200);
  }
}

TEST_CASE("with compliance a row is determined unless a state of self-stress of the rigid rows contains it") {
  std::mt19937 random(78);
  int wrong = 0, open = 0;
  for (int k = 0; k < 300; ++k) {
    const Truss t = random_truss(random);
    const std::vector<char> determined = determined_rows(sparse_rows(t.G), t.compliance);
    MatrixXd rigid = t.G;  // a row of zeros is in no state but its own
    for (Index i = 0; i < rigid.rows(); ++i)
      if (t.compliance[i] > 0) rigid.row(i).setZero();
    MatrixXd N = null_space(rigid.transpose());
    for (Index i = 0; i < rigid.rows(); ++i) {
      const bool in_none = t.compliance[i] > 0 || N.row(i).norm() < 1e-9;
      wrong += in_none != (determined[static_cast<std::size_t>(i)] != 0);
      open += !in_none;
    }
  }
  CHECK(wrong == 0);
  CHECK(open > 50);
}

}  // namespace least_energy_test
