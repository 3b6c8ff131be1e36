// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/determined_rows.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/math/factors.hpp"
#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace determined_rows_test {

using testing::sparse_rows;

namespace {

Index rank(const MatrixXd& A) {
  return A.size() > 0 ? rank_of(A, 1e-9) : 0;
}

// The rows of length 1 of a random pin-jointed frame in space: `rods` rods between random pairs of `nodes`
// nodes (some may be equal, or have the same ends), a few coordinates held.
MatrixXd random_frame(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const int nodes = 3 + any(5), rods = 3 + any(3 * nodes), held = any(7);
  MatrixXd x(3, nodes);
  for (Index i = 0; i < x.size(); ++i) x.data()[i] = uniform(random);
  MatrixXd G = MatrixXd::Zero(rods + held, 3 * nodes);
  for (int r = 0; r < rods; ++r) {
    const int a = any(nodes), b = (a + 1 + any(nodes - 1)) % nodes;
    const Vec3 d = (x.col(b) - x.col(a)).normalized();
    G.block<1, 3>(r, 3 * a) = -d.transpose();
    G.block<1, 3>(r, 3 * b) = d.transpose();
  }
  for (int h = 0; h < held; ++h) G(rods + h, any(3 * nodes)) = 1;
  return G;
}

}  // namespace

TEST_CASE("a row is determined if and only if removing it lowers the rank: 1000 random frames") {
  std::mt19937 random(20240901);
  int open = 0, closed = 0, wrong = 0;
  for (int k = 0; k < 1000; ++k) {
    const MatrixXd G = random_frame(random);
    const std::vector<char> determined = determined_rows(sparse_rows(G));
    const Index all = rank(G);
    for (Index r = 0; r < G.rows(); ++r) {
      MatrixXd rest(G.rows() - 1, G.cols());
      rest << G.topRows(r), G.bottomRows(G.rows() - 1 - r);
      const bool lowers = rank(rest) < all;
      ++(lowers ? closed : open);
      wrong += lowers != (determined[static_cast<std::size_t>(r)] != 0);
    }
  }
  CHECK(wrong == 0);
  CHECK(open > 2000);  // both kinds are common among them
  CHECK(closed > 2000);
}

TEST_CASE("rows that repeat one, at any scale, are not determined, others stay so, zeros are not") {
  MatrixXd G(5, 4);
  G << 1, 2, 0, 0,  //
      0, 3, -1, 0,  //
      0, 0, 2, 7,   //
      0, 3e9, -1e9, 0, 0, 0, 0, 0;
  CHECK(determined_rows(sparse_rows(G)) == std::vector<char>{1, 0, 1, 0, 0});
  CHECK(determined_rows(SparseRows(0, 4)).empty());
}

TEST_CASE("how singular a pose may be for its rows to be told apart") {
  // Two bars nearly on one line, angle delta: singular value delta / sqrt(2). Independent down to 1e-6.
  for (const double delta : {1e-1, 1e-3, 1e-5, 3e-6}) {
    MatrixXd G(2, 2);
    G << 1, 0, std::cos(delta), std::sin(delta);
    INFO("angle " << delta);
    CHECK(determined_rows(sparse_rows(G)) == std::vector<char>{1, 1});
  }
  MatrixXd line(2, 2);
  line << 1, 0, 1, 1e-12;
  CHECK(determined_rows(sparse_rows(line)) == std::vector<char>{0, 0});
}

// y_0 and 2 y_1 + y_0 of G = (1; 2), which says f = y_0 + 2 y_1 only; a row beside them is on its own.
TEST_CASE("sums over rows are determined where what rows have each is open") {
  SparseRows G(3, 2);
  G.insert(0, 0) = 1, G.insert(1, 0) = 2, G.insert(2, 1) = 5;
  CHECK(determined_rows(G) == std::vector<char>{0, 0, 1});
  const auto taken = [&](double a, double b, double c) -> SparseRows {
    return Eigen::Vector3d(a, b, c).asDiagonal() * G;
  };
  CHECK(determined_sums(G, taken(1, 1, 0)) == std::vector<char>{1, 1});
  CHECK(determined_sums(G, taken(1, 0, 1)) == std::vector<char>{0, 1});
  CHECK(determined_sums(G, taken(1, 0, 1), Eigen::Vector3d(1, 0, 0)) == std::vector<char>{1, 1});
}

TEST_CASE("round-off of every row is left out by its own length") {
  for (const double scale : {1.0, 1e-6, 3e8}) {
    MatrixXd G(3, 3), clean(3, 3);
    G << 1.7, 2e-12, 0.9, 1e-14, -2.3, 3e-11, 4e-11, 5e-12, 1.1;
    clean << 1.7, 0, 0.9, 0, -2.3, 3e-11, 4e-11, 0, 1.1;
    G.row(1) *= scale, clean.row(1) *= scale;
    CHECK(MatrixXd(without_round_off_transposed(sparse_rows(G))) == clean.transpose());
  }
}

}  // namespace determined_rows_test
