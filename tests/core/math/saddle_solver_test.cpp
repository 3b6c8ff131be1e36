// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/saddle_solver.hpp"
#include "core/math/factors.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <random>
#include <thread>
#include <vector>

#include "tests/support/sparse_rows.hpp"

using namespace unfurl;

namespace saddle_solver_test {

using testing::sparse_rows;

namespace {

// Random M (diagonally dominant, positive definite) and G with some rows repeated.
struct Problem {
  MatrixXd M, G;
  VectorXd f, g;
};

Problem random_problem(int n, int rows, int repeated, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Problem p{MatrixXd::Zero(n, n), MatrixXd::Zero(rows + repeated, n), VectorXd(n),
            VectorXd::Zero(rows + repeated)};
  for (int i = 0; i < n; ++i) {
    p.M(i, i) = std::pow(10.0, 2 * uniform(random));
    p.f[i] = uniform(random);
  }
  for (int i = 0; i + 1 < n; ++i)
    p.M(i, i + 1) = p.M(i + 1, i) = 0.3 * std::min(p.M(i, i), p.M(i + 1, i + 1));
  for (int r = 0; r < rows; ++r)
    for (int k = 0; k < 4; ++k)
      p.G(r, static_cast<int>(random() % static_cast<unsigned>(n))) = uniform(random);
  for (int r = 0; r < repeated; ++r) p.G.row(rows + r) = 2.0 * p.G.row(r) - p.G.row(r + 1);
  p.g = p.G * VectorXd::Ones(n);  // consistent
  return p;
}

}  // namespace

TEST_CASE("the saddle-point solver agrees with a dense rank-revealing solve, redundant rows included") {
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (int repeated : {0, 3}) {
      const Problem p = random_problem(24, 10, repeated, seed);
      SaddleSolver solver(sparse_rows(p.M), sparse_rows(p.G));
      REQUIRE(solver.factorise(sparse_rows(p.G)));
      VectorXd x(p.f.size()), y(p.g.size());
      const double residual = solver.solve(p.f, p.g, x, y);
      MatrixXd K = MatrixXd::Zero(34 + repeated, 34 + repeated);
      K << p.M, p.G.transpose(), p.G, MatrixXd::Zero(p.G.rows(), p.G.rows());
      VectorXd b(K.rows());
      b << p.f, p.g;
      const VectorXd dense = least_squares(K, b);
      INFO("seed " << seed << ", repeated rows " << repeated);
      // Condition numbers reach 1e5 here (masses from 1e-2 to 1e2): 1e5 ulp on either side.
      CHECK((x - dense.head(24)).norm() <= 1e-10 * dense.head(24).norm());
      CHECK(residual <= 1e-14);
      // Multipliers are unique up to the null space of G^T: the forces G^T y are unique.
      CHECK((p.G.transpose() * (y - dense.tail(y.size()))).norm() <= 1e-9 * p.f.norm());
    }
}

// Entries of order one, and one in three of a hundredth: a row has its own coordinate by a large one.
TEST_CASE("the sparse order solves to the same digits, with less fill, and redundant rows beside it") {
  Index fill[2] = {0, 0};
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const int repeated : {0, 3}) {
      Problem p = random_problem(60, 40, repeated, seed);
      std::mt19937 random(seed);
      for (int r = 0; r < 40; ++r)
        for (int c = 0; c < 60; ++c)
          if (random() % 3 == 0) p.G(r, c) *= 0.01;
      for (int r = 0; r < repeated; ++r) p.G.row(40 + r) = 2.0 * p.G.row(r) - p.G.row(r + 1);
      p.g = p.G * VectorXd::Ones(60);
      VectorXd x[2], y[2];
      for (const int k : {0, 1}) {
        SaddleSolver solver(sparse_rows(p.M), sparse_rows(p.G), 1, SaddleSolver::standard_regularisation,
                            k == 0 ? SaddleSolver::Order::safe : SaddleSolver::Order::sparse_first);
        REQUIRE(solver.factorise(sparse_rows(p.G)));
        x[k].resize(60), y[k].resize(40 + repeated);
        // Round-off alone: a hundred terms, and unknowns up to a hundred times the right-hand side.
        CHECK(solver.solve(p.f, p.g, x[k], y[k]) <= 1e-13);
        fill[k] += solver.factor_nonzeros();
      }
      INFO("seed " << seed << ", repeated rows " << repeated);
      // Condition numbers as above.
      CHECK((x[1] - x[0]).norm() <= 1e-10 * x[0].norm());
      CHECK((p.G.transpose() * (y[1] - y[0])).norm() <= 1e-9 * p.f.norm());
    }
  CHECK(fill[1] < fill[0]);
}

// Three rows on four coordinates. Of the pose that the order is made for, row k has coordinate k for its own;
// then that of the first row goes to zero: a pivot of e, and growth by its inverse.
TEST_CASE("where the sparse order brings growth the safe one is taken, matrix by matrix") {
  MatrixXd M = MatrixXd::Identity(4, 4), G(3, 4);
  G << 0.9, 0.02, 0.03, 0.4, 0.3, 0.8, 0.02, 0.5, 0.1, 0.2, 0.7, 0.6;
  SaddleSolver solver(sparse_rows(M), sparse_rows(G), 1, SaddleSolver::standard_regularisation,
                      SaddleSolver::Order::sparse_first);
  for (const double entry : {0.9, 1e-9, 0.0, 0.7, 1e-4}) {
    for (int c = 0; c < 3; ++c) G(0, c) = c == 0 ? entry : entry * 1e-3;
    SparseRows rows = sparse_rows(MatrixXd::Ones(3, 4));
    for (int r = 0; r < 3; ++r)
      for (SparseRows::InnerIterator it(rows, r); it; ++it) it.valueRef() = G(r, it.col());
    INFO("own entry " << entry);
    REQUIRE(solver.factorise(rows));
    const Eigen::Vector4d f(0.3, -0.2, 0.7, 0.4);
    const Eigen::Vector3d g(0.1, 0.5, -0.3);
    MatrixXd K = MatrixXd::Zero(7, 7);
    K << M, G.transpose(), G, MatrixXd::Zero(3, 3);
    VectorXd b(7), x(4), y(3);
    b << f, g;
    solver.solve(f, g, x, y);
    const VectorXd exact = least_squares(K, b);
    CHECK((x - exact.head(4)).norm() <= 1e-12 * exact.norm());
    CHECK((y - exact.tail(3)).norm() <= 1e-12 * exact.norm());
    // One application has no refinement to mend growth: what e leaves, over squares of singular values that
    // are above 0.01 here.
    VectorXd once_x = f, once_y = g;
    solver.apply(once_x.data(), once_y.data(), 1);
    CHECK((once_x - exact.head(4)).norm() <= 1e-8 * exact.norm());
  }
}

TEST_CASE("weak directions are found behind the sparse order, too") {
  for (const double a : {1e-9, 1e-6, 1e-4}) {
    MatrixXd G(4, 5), M = MatrixXd::Identity(5, 5);
    G << 1, 0, 0, 0.3, 0, std::cos(a), std::sin(a), 0, 0.3 * std::cos(a), 0, 0, 0.2, 1, 0, 0.4, 0, 0, 0.5,
        0.9, 0.7;
    SaddleSolver sparse(sparse_rows(M), sparse_rows(G), 1, SaddleSolver::standard_regularisation,
                        SaddleSolver::Order::sparse_first),
        safe(sparse_rows(M), sparse_rows(G));
    REQUIRE(sparse.factorise(sparse_rows(G)));
    REQUIRE(safe.factorise(sparse_rows(G)));
    // Pivots of a weak row depend on the order in which rows come: they are of one size.
    const double found = sparse.weakest_pivot(1e-3), known = safe.weakest_pivot(1e-3);
    CHECK(known < 1e-3);
    CHECK(found == known);
    CHECK(!sparse.in_first_order());
    REQUIRE(sparse.factorise(sparse_rows(G)));
    CHECK(sparse.weakest_pivot(1e-3 * a * a) == 1e-3 * a * a);  // none below
  }
}

// An analysis is shared by the solvers of a thread: one that was made by itself, in a thread of its own, has
// the same bits, whatever matrices of the same pattern, other orders and other e were there before.
TEST_CASE("a solver that comes after others solves as one made by itself does") {
  struct Made {
    const Problem* p;
    double e;
    SaddleSolver::Order order;
  };
  const auto solution = [](const Made& made) {
    const SparseRows G = sparse_rows(made.p->G);
    SaddleSolver solver(sparse_rows(made.p->M), G, 1, made.e, made.order);
    VectorXd x(made.p->f.size()), y(made.p->g.size());
    if (solver.factorise(G)) solver.solve(made.p->f, made.p->g, x, y);
    return x;
  };
  const Problem one = random_problem(24, 10, 3, 1);
  Problem heavy = one, turned = one;
  heavy.M *= 3;
  turned.G.row(0) *= -0.01;
  turned.G.row(1).reverseInPlace();
  turned.g = turned.G * VectorXd::Ones(24);
  std::vector<Made> all;
  for (const Problem* p : std::vector<const Problem*>{&one, &heavy, &turned})
    for (const double e : {1e-13, 1e-7})
      for (const auto order : {SaddleSolver::Order::safe, SaddleSolver::Order::sparse_first})
        all.push_back({p, e, order});
  for (int round = 0; round < 2; ++round)
    for (const Made& made : all) {
      const VectorXd here = solution(made);
      VectorXd alone;
      std::thread([&] { alone = solution(made); }).join();
      CHECK((here.array() == alone.array()).all());
    }
}

TEST_CASE("multipliers of repeated rows come with least norm") {
  MatrixXd M = MatrixXd::Identity(2, 2), G(3, 2);
  G << 1, 0, 1, 0, 1, 0;  // one rod three times: each carries a third
  SaddleSolver solver(sparse_rows(M), sparse_rows(G));
  REQUIRE(solver.factorise(sparse_rows(G)));
  VectorXd x(2), y(3);
  solver.solve(Eigen::Vector2d(3, 5), VectorXd::Zero(3), x, y);
  // Round-off in directions without rank is 1e-16 / e = 1e-6.
  for (int r = 0; r < 3; ++r) CHECK(y[r] == Approx(1.0).epsilon(3e-6));
  CHECK(std::abs(x[0]) <= 1e-15);
  CHECK(x[1] == Approx(5.0).epsilon(1e-15));
}

TEST_CASE("several right-hand sides at once give what each gives alone") {
  const Problem p = random_problem(30, 12, 2, 7);
  SaddleSolver solver(sparse_rows(p.M), sparse_rows(p.G), 7);
  REQUIRE(solver.factorise(sparse_rows(p.G)));
  const int columns = 7;
  std::vector<double> f(30 * columns), g(14 * columns);
  for (int i = 0; i < 30; ++i)
    for (int c = 0; c < columns; ++c) f[static_cast<std::size_t>(i * columns + c)] = p.f[i] * (c + 1);
  for (int i = 0; i < 14; ++i)
    for (int c = 0; c < columns; ++c) g[static_cast<std::size_t>(i * columns + c)] = p.g[i] * (c + 1);
  solver.apply(f.data(), g.data(), columns);
  VectorXd f1 = p.f, g1 = p.g;
  solver.apply(f1.data(), g1.data(), 1);
  for (int i = 0; i < 30; ++i)
    for (int c = 0; c < columns; ++c)  // the same operations, scaled: a few hundred of them
      CHECK(f[static_cast<std::size_t>(i * columns + c)] ==
            Approx((c + 1) * f1[i]).epsilon(1e-10).margin(1e-12));
}

// Rows (1, 0, 0), (cos a, sin a, 0) and the second once more: x = (g_1, (g_2 - g_1 cos a) / sin a, f_3 /
// M_33).
TEST_CASE("a direction of singular value 1e-9 beside a redundant row is solved in twice the digits") {
  const double a = 1e-9;
  MatrixXd G(3, 3), M = MatrixXd::Identity(3, 3);
  G << 1, 0, 0, std::cos(a), std::sin(a), 0, std::cos(a), std::sin(a), 0;
  SaddleSolver solver(sparse_rows(M), sparse_rows(G));
  REQUIRE(solver.factorise(sparse_rows(G)));
  const double pivot = solver.weakest_pivot(1e-3);
  CHECK(pivot == Approx(a * a).epsilon(0.01));  // 1 - cos^2 a
  const Eigen::Vector3d f(0.0, 0.2 * a, 0.7), g(0.0, 0.3 * a, 0.3 * a);
  VectorXd x(3), y(3);
  solver.solve(f, g, x, y);
  CHECK(x[0] == Approx(0.0).epsilon(0).margin(1e-15));
  CHECK(x[1] == Approx(0.3).epsilon(1e-13));
  CHECK(x[2] == Approx(0.7).epsilon(1e-15));
  // (y_2 + y_3) sin a = f_2 - x_2, in equal parts: least norm.
  CHECK(y[1] * a == Approx(0.5 * (0.2 * a - 0.3)).epsilon(1e-9));
  CHECK(y[2] == Approx(y[1]).epsilon(1e-9));
  // One application, as iterations use it: e / a^2 = 1e-5 short of it.
  std::vector<double> xs(f.data(), f.data() + 3), ys(g.data(), g.data() + 3);
  solver.apply(xs.data(), ys.data(), 1);
  CHECK(xs[1] == Approx(0.3).epsilon(1e-4));
}

TEST_CASE("doubles serve where no direction is weak, whatever is redundant") {
  MatrixXd G(3, 3), M = MatrixXd::Identity(3, 3);
  G << 1, 0, 0, 0.6, 0.8, 0, 0.6, 0.8, 0;
  SaddleSolver solver(sparse_rows(M), sparse_rows(G));
  REQUIRE(solver.factorise(sparse_rows(G)));
  CHECK(solver.weakest_pivot(1e-3) == 1e-3);  // none below
  REQUIRE(solver.factorise(sparse_rows(G)));
  CHECK(solver.weakest_pivot(0.9) == Approx(0.64).epsilon(1e-9));
}

// A closed loop of n rods in line, each row x_k - x_(k-1): the last row is minus the sum of the others, so
// that e makes 1 + n times itself of its pivot, beyond what other redundant rows have. No pivot is smaller
// than the square of the smallest singular value, 2 sin(pi / 2n) in rows of length sqrt(2).
TEST_CASE("a row that follows from thousands of others is redundant and no weak direction") {
  const int n = 4000;
  std::vector<Eigen::Triplet<double>> entries, unit;
  for (int k = 0; k < n; ++k) {
    unit.emplace_back(k, k, 1.0);
    entries.emplace_back(k, k, -1.0);
    entries.emplace_back(k, (k + 1) % n, 1.0);
  }
  SparseRows M(n, n), G(n, n);
  M.setFromTriplets(unit.begin(), unit.end());
  G.setFromTriplets(entries.begin(), entries.end());
  SaddleSolver solver(M, G);
  REQUIRE(solver.factorise(G));
  const double smallest = 2 * std::sin(1.5707963267948966 / n);
  CHECK(solver.weakest_pivot(1e-4) >= 0.5 * smallest * smallest);
}

// e far below the last digit of the other terms: of the second row nothing is left, not even e.
TEST_CASE("a repeated row whose pivot round-off cancels is solved all the same") {
  MatrixXd G(2, 2), M = MatrixXd::Identity(2, 2);
  G << 1, 0, 1, 0;
  SaddleSolver solver(sparse_rows(M), sparse_rows(G), 1, 1e-20);
  REQUIRE(solver.factorise(sparse_rows(G)));
  VectorXd x(2), y(2);
  solver.solve(Eigen::Vector2d(3, 5), VectorXd::Zero(2), x, y);
  CHECK(std::abs(x[0]) <= 1e-15);
  CHECK(x[1] == Approx(5.0).epsilon(1e-15));
  CHECK(y[0] + y[1] == Approx(3.0).epsilon(1e-15));
}

}  // namespace saddle_solver_test
