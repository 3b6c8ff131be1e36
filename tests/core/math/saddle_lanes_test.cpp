// SPDX-License-Identifier: BSD-3-Clause
// Lanes against the solver that they stand for, one matrix at a time: no bit may differ.
#include "core/math/saddle_lanes.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace saddle_lanes_test {

using testing::sparse_rows;

namespace {

constexpr int n = 19, m = 13;

// Four entries a row; the last three rows follow from the first ones where `redundant`.
MatrixXd random_rows(std::mt19937& random, const MatrixXd& pattern, bool redundant) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  MatrixXd G = MatrixXd::Zero(m, n);
  for (int r = 0; r < m; ++r)
    for (int c = 0; c < n; ++c)
      if (pattern(r, c) != 0) G(r, c) = uniform(random);
  for (int r = 0; redundant && r < 3; ++r) G.row(m - 3 + r) = 0.7 * G.row(r) - 1.9 * G.row(r + 1);
  return G;
}

MatrixXd random_pattern(std::mt19937& random) {
  MatrixXd pattern = MatrixXd::Zero(m, n);
  for (int r = 0; r < m - 3; ++r)
    for (int k = 0; k < 4; ++k) pattern(r, static_cast<int>(random() % unsigned{n})) = 1;
  for (int r = 0; r < 3; ++r) pattern.row(m - 3 + r) = pattern.row(r).cwiseMax(pattern.row(r + 1));
  return pattern;
}

bool same_bits(const VectorXd& a, const VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

// The entries of the pattern, those that happen to be zero too.
SparseRows with_pattern(const MatrixXd& G, const MatrixXd& pattern) {
  SparseRows out = sparse_rows(pattern);
  for (int r = 0; r < out.outerSize(); ++r)
    for (SparseRows::InnerIterator it(out, r); it; ++it) it.valueRef() = G(r, it.col());
  return out;
}

}  // namespace

TEST_CASE("a lane has the bits of a solver of its own, whatever lies in the others") {
  std::mt19937 random(20261122);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::array<int, 2> shown{};  // how often there may be a pivot below a bound, and how often there is none
  for (int trial = 0; trial < 40; ++trial) {
    const MatrixXd pattern = random_pattern(random);
    MatrixXd M = MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) M(i, i) = std::pow(10.0, uniform(random));
    for (int i = 0; i + 1 < n; ++i) M(i, i + 1) = M(i + 1, i) = 0.3 * std::min(M(i, i), M(i + 1, i + 1));
    const double regularisation = trial % 2 == 0 ? 1e-7 : SaddleSolver::standard_regularisation;
    const auto order = trial % 4 < 2 ? SaddleSolver::Order::safe : SaddleSolver::Order::sparse_first;
    SaddleSolver alone(sparse_rows(M), sparse_rows(pattern), 1, regularisation, order);
    SaddleSolver handed(sparse_rows(M), sparse_rows(pattern), 1, regularisation, order);
    SaddleLanes lanes(alone);
    SaddleLanes::Vectors f, g, x, y;
    std::array<SparseRows, SaddleLanes::lanes> G;
    for (std::size_t c = 0; c < f.size(); ++c) {
      MatrixXd rows = random_rows(random, pattern, (trial + static_cast<int>(c)) % 3 == 0);
      if (trial == 7 && c == 2) rows.row(4).setConstant(std::numeric_limits<double>::infinity());
      if (trial == 8 && c == 1) rows.setZero();
      G[c] = with_pattern(rows, pattern);
      f[c] = VectorXd::NullaryExpr(n, [&] { return uniform(random); });
      g[c] = VectorXd::NullaryExpr(m, [&] { return uniform(random); });  // not within reach where redundant
      if (trial == 9 && c == 3) f[c][5] = std::numeric_limits<double>::quiet_NaN();
      if (trial == 10 && c == 0) f[c].setZero(), g[c].setZero();
      lanes.set(static_cast<int>(c), G[c]);
    }
    lanes.factorise();
    lanes.solve(f, g, x, y, 40);
    for (std::size_t c = 0; c < f.size(); ++c) {
      INFO("trial " << trial << ", lane " << c);
      const bool ok = alone.factorise(G[c]);
      const bool in_lane = ok && alone.in_first_order();
      REQUIRE(lanes.ok(static_cast<int>(c)) == in_lane);
      for (const double bound : {1e-6, 1e-3, 0.03, 0.1}) {
        const bool none = in_lane && alone.shows_none_below(bound);
        CHECK(lanes.shows_none_below(static_cast<int>(c), bound, handed) == none);
        ++shown[none ? 1 : 0];
      }
      if (!in_lane) {
        CHECK(lanes.hand_over(static_cast<int>(c), handed) == ok);
        continue;
      }
      VectorXd one_x(n), one_y(m);
      alone.solve(f[c], g[c], one_x, one_y, 40);
      CHECK((same_bits(x[c], one_x) || (!x[c].allFinite() && !one_x.allFinite())));
      CHECK((same_bits(y[c], one_y) || (!y[c].allFinite() && !one_y.allFinite())));
      REQUIRE(lanes.hand_over(static_cast<int>(c), handed));
      CHECK(handed.weakest_pivot(1e-3) == alone.weakest_pivot(1e-3));
      VectorXd handed_x(n), handed_y(m);
      alone.solve(f[c], g[c], one_x, one_y, 40);
      handed.solve(f[c], g[c], handed_x, handed_y, 40);
      CHECK((same_bits(handed_x, one_x) || !one_x.allFinite()));
      CHECK((same_bits(handed_y, one_y) || !one_y.allFinite()));
    }
  }
  CHECK(shown[0] > 100);
  CHECK(shown[1] > 100);
}

}  // namespace saddle_lanes_test
