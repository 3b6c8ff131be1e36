// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/elimination_choice.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace unfurl;

namespace elimination_choice_test {

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

SparseRows matrix(Index rows, Index columns, const Entries& entries) {
  SparseRows out(rows, columns);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

// Coordinates p_i = c_i h + b_i of a hub h that n of them follow, and t_ik, `rows` for each, which
// constraints tie to p_i. p_5 has no mass.
struct Hub {
  int n, rows;
  int h() const { return n; }
  int t(int i, int k) const { return n + 1 + rows * i + k; }
  Index size() const { return n + 1 + rows * n; }
  double c(int i) const { return 0.2 + 0.2 * std::abs(std::sin(1.0 + i)); }

  LinearElimination chosen(VectorXd& b, SparseRows& A) const {
    Entries follow, mass, rest;
    for (int i = 0; i < n; ++i) {
      follow.emplace_back(i, i, 1.0), follow.emplace_back(i, h(), -c(i));
      for (int k = 0; k < rows; ++k)
        rest.emplace_back(rows * i + k, i, 0.7), rest.emplace_back(rows * i + k, t(i, k), -0.4 - 0.1 * k);
    }
    for (int i = 0; i < size(); ++i) mass.emplace_back(i, i, i == 5 ? 0.0 : 1.0 + 0.01 * i);
    A = matrix(n, size(), follow);
    b.resize(n);
    for (int i = 0; i < n; ++i) b[i] = 0.3 - 0.02 * i;
    return choose_elimination(A, b, matrix(size(), size(), mass), matrix(rows * n, size(), rest));
  }
};

}  // namespace

// Each constraint of an eliminated p_i is one of the hub's: of 3 n of them the hub fills a square of (3 n)^2
// / 2, where it has n rows if they are left. Without any it has a mass, and nothing else is left of n
// coordinates.
TEST_CASE("followers of a hub are eliminated where that saves work") {
  for (const auto& [n, rows] : {std::pair(60, 3), {60, 0}, {20, 3}}) {
    INFO(n << " followers, " << rows << " constraints of each");
    const Hub hub{n, rows};
    VectorXd b;
    SparseRows A;
    const LinearElimination e = hub.chosen(b, A);
    CHECK(e.kept.empty() == !(n == 60 && rows == 3));
    CHECK(std::ssize(e.kept) < n);
    CHECK(std::ranges::find(e.kept, 5) == e.kept.end());  // without mass it has no equation of its own
    CHECK(e.B.cols() == hub.size() - n + std::ssize(e.kept));
    VectorXd z(e.B.cols());
    for (Index i = 0; i < z.size(); ++i) z[i] = std::cos(0.4 + 1.7 * static_cast<double>(i));
    const VectorXd left = A * (e.q0 + e.B * z) - b;
    for (int i = 0; i < n; ++i)
      if (std::ranges::find(e.kept, i) == e.kept.end()) CHECK(std::abs(left[i]) < 1e-14);
  }
}

}  // namespace elimination_choice_test
