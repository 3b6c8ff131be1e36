// SPDX-License-Identifier: BSD-3-Clause
// Bounded pushes against every choice of what holds, tried one by one.
#include "core/math/box_complementarity.hpp"
#include "core/math/factors.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace unfurl;

namespace box_complementarity_test {

namespace {

struct Problem {
  MatrixXd D;
  VectorXd b, low, high;
};

// Is w right for x, up to round-off of terms of size one?
bool fulfils(const Problem& p, const VectorXd& x, double tolerance) {
  const VectorXd w = p.D * x + p.b;
  for (Index i = 0; i < x.size(); ++i) {
    if (x[i] < p.low[i] - tolerance || x[i] > p.high[i] + tolerance) return false;
    if (w[i] > tolerance && x[i] > p.low[i] + tolerance) return false;
    if (w[i] < -tolerance && x[i] < p.high[i] - tolerance) return false;
  }
  return true;
}

// Each row at its lower bound, at its upper one or held: 3^n choices, the held rows by least squares.
std::optional<VectorXd> by_enumeration(const Problem& p) {
  const Index n = p.b.size();
  const auto choices = static_cast<Index>(std::lround(std::pow(3.0, static_cast<double>(n))));
  for (Index choice = 0; choice < choices; ++choice) {
    VectorXd x = p.low;
    std::vector<Index> held;
    bool finite = true;
    for (Index i = 0, rest = choice; i < n; ++i, rest /= 3) {
      if (rest % 3 == 1) x[i] = p.high[i], finite = finite && std::isfinite(p.high[i]);
      if (rest % 3 == 2) x[i] = 0, held.push_back(i);
    }
    if (!finite) continue;
    if (!held.empty()) {
      const VectorXd rest = -(p.D * x + p.b);
      const MatrixXd part = p.D(held, held);
      const VectorXd found = least_squares(part, rest(held));
      for (std::size_t k = 0; k < held.size(); ++k) x[held[k]] = found[static_cast<Index>(k)];
    }
    if (fulfils(p, x, 1e-9)) return VectorXd(p.D * x + p.b);
  }
  return std::nullopt;
}

// Gradients of n measures in a space of `rank` dimensions; the first ones stops, the others friction.
Problem drawn(std::mt19937& random, Index n, Index rank) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Problem p;
  MatrixXd N(n, rank);
  for (double& x : N.reshaped()) x = uniform(random);
  if (n > 2 && uniform(random) > 0) N.row(n - 1) = -0.7 * N.row(0);  // two on one measure
  const double size = std::exp(4 * uniform(random));
  p.D = size * N * N.transpose();
  // Half of them from a motion, which some push can stop where the rows are dependent.
  p.b.resize(n);
  for (double& x : p.b) x = uniform(random);
  if (uniform(random) > 0) p.b = N * VectorXd::NullaryExpr(rank, [&] { return uniform(random); });
  p.low = p.high = VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) {
    const bool stop = uniform(random) > 0;
    p.high[i] = stop ? std::numeric_limits<double>::infinity() : std::abs(uniform(random)) / size;
    p.low[i] = stop ? 0.0 : -p.high[i];
  }
  return p;
}

}  // namespace

TEST_CASE("pushes in a box are those of one of all choices, for independent and redundant rows") {
  std::mt19937 random(31);
  int solved = 0, without = 0, redundant = 0;
  for (int k = 0; k < 4000; ++k) {
    const Index n = 1 + k % 5, rank = 1 + (k / 5) % 5;
    const Problem p = drawn(random, n, rank);
    const auto expected = by_enumeration(p);
    const auto found = solve_box(p.D, p.b, p.low, p.high);
    INFO("problem " << k << ", " << n << " rows of rank " << rank);
    REQUIRE(found.has_value() == expected.has_value());
    if (!found) {
      ++without;
      continue;
    }
    ++solved;
    redundant += rank < n;
    const double size = p.b.lpNorm<Eigen::Infinity>();
    CHECK((found->w - *expected).lpNorm<Eigen::Infinity>() <= 1e-7 * size);
    std::vector<bool> before(static_cast<std::size_t>(n), false);
    for (Index i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(i);
      CHECK(found->x[i] >= p.low[i]);
      CHECK(found->x[i] <= p.high[i]);
      if (!found->held[row]) continue;
      CHECK(std::abs(found->w[i]) <= 1e-9 * size);
      CHECK(independent(p.D, before, i));
      before[row] = true;
    }
  }
  CHECK(solved > 2500);
  CHECK(without > 100);
  CHECK(redundant > 1000);
}

TEST_CASE("a push that is given and hardly moves anything decides nothing about the others") {
  // Of unit diagonal its motion were 1e14; 20 = 2 x.
  const MatrixXd D = (MatrixXd(2, 2) << 2, 1e-14, 1e-14, 1e-26).finished();
  const auto found = solve_box(D, Eigen::Vector2d(-20, 12), Eigen::Vector2d(-30, 2), Eigen::Vector2d(30, 2));
  REQUIRE(found.has_value());
  CHECK(found->x[0] == Approx(10));
  CHECK(found->held[0]);
}

// Frictions of one freedom, whose rows are known to rounding: what acts is next to nothing beside their
// bounds, and not quite the same by each. Each of them is right to that and to rounding of the bounds.
TEST_CASE("rows of one freedom that contradict each other far below their bounds have an answer") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double size : {1.0, 1e-8, 1e-14, 1e-20, 1e-60})
    for (int k = 0; k < 300; ++k) {
      const Index n = 2 + k % 4;
      const VectorXd row = VectorXd::NullaryExpr(n, [&] { return uniform(random); }),
                     bound = VectorXd::NullaryExpr(n, [&] { return 0.1 + std::abs(uniform(random)); });
      MatrixXd D = row * row.transpose();
      for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < i; ++j) D(i, j) = D(j, i) *= 1 + 2e-16 * uniform(random);
      const VectorXd b = VectorXd::NullaryExpr(n, [&] { return size * uniform(random); });
      const auto found = solve_box(D, b, -bound, bound);
      INFO(size << ", " << k);
      REQUIRE(found.has_value());
      CHECK(fulfils({D, b, -bound, bound}, found->x, 1e-13));
    }
}

// Whatever is held after that, held rows are independent, nothing else bears what it can give over, stops
// push, and no acceleration has changed.
TEST_CASE("what is not held gives over what it bears and what is held still only pushes") {
  std::mt19937 random(37);
  int over = 0, instead = 0;
  for (int k = 0; k < 3000; ++k) {
    const Problem p = drawn(random, 2 + k % 5, 1 + (k / 5) % 4);
    auto solution = solve_box(p.D, p.b, p.low, p.high);
    if (!solution) continue;
    const double size = p.b.lpNorm<Eigen::Infinity>(), most = 1 + solution->x.lpNorm<Eigen::Infinity>();
    std::vector<bool> pushes;
    for (const double high : p.high) pushes.push_back(!std::isfinite(high));
    for (Index i = 0; i < p.b.size(); ++i) {
      const auto one = static_cast<std::size_t>(i);
      if (pushes[one] || solution->held[one] || std::abs(solution->w[i]) > 1e-9 * size) continue;
      if (independent(p.D, solution->held, i)) continue;
      INFO("problem " << k << ", row " << i);
      give_over(p.D, pushes, i, *solution);
      ++(solution->held[one] ? instead : over);
      CHECK((solution->held[one] || std::abs(solution->x[i]) <= 1e-12 * most));
      CHECK((p.D * solution->x + p.b - solution->w).lpNorm<Eigen::Infinity>() <= 1e-7 * size);
      std::vector<bool> before(solution->held.size(), false);
      for (std::size_t j = 0; j < before.size(); ++j) {
        if (pushes[j]) CHECK(solution->x[static_cast<Index>(j)] >= -1e-9 * most);
        if (!solution->held[j]) continue;
        CHECK(independent(p.D, before, static_cast<Index>(j)));
        before[j] = true;
      }
    }
  }
  CHECK(over > 50);
  CHECK(instead > 5);
}

// One body between two walls meets the one as fast as it leaves the other; its rates are of a motion that is
// 1e4 times as fast.
TEST_CASE("walls on either side of what hardly moves agree to the rounding of its rates") {
  const MatrixXd D = (MatrixXd(2, 2) << 1, -1, -1, 1).finished();
  const Eigen::Vector2d b(-1e-4, 1e-4 - 1e-15), low(0, 0);
  const Eigen::Vector2d high = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  const auto found = solve_box(D, b, low, high, VectorXd::Constant(2, 1e-14));
  REQUIRE(found.has_value());
  CHECK(found->x[0] - found->x[1] == Approx(1e-4).epsilon(0).margin(1e-14));
  CHECK(found->w.lpNorm<Eigen::Infinity>() <= 1e-14);
}

}  // namespace box_complementarity_test
