// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/box_complementarity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/factors.hpp"

namespace unfurl {
namespace {

constexpr double box_dependent = 1e-9;  // of a unit diagonal
constexpr double box_zero = 1e-12;      // of the largest b of a row with a choice, in the unit diagonal
constexpr double sum_zero = 1e-15;      // of what is summed in a row: pushes may be far larger than b
constexpr double unbounded = std::numeric_limits<double>::infinity();

std::vector<Index> rows_of(const std::vector<bool>& held) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i]) rows.push_back(static_cast<Index>(i));
  return rows;
}

}  // namespace

VectorXd past_held(const MatrixXd& D, const std::vector<bool>& held, Index i) {
  const std::vector<Index> rows = rows_of(held);
  VectorXd d = VectorXd::Zero(D.rows());
  d[i] = 1;
  if (rows.empty()) return d;
  const VectorXd part = Cholesky(D(rows, rows)).solve(VectorXd(D(rows, std::vector{i}).col(0)));
  for (std::size_t k = 0; k < rows.size(); ++k) d[rows[k]] = -part[static_cast<Index>(k)];
  return d;
}

namespace {

// Dantzig's method with bounds: one row after the other is moved until its w is right, along the line on
// which the held rows stay at w = 0; a held row that meets a bound on the way stays there. x^T D x / 2 + b^T
// x falls all the time.
class BoxProblem {
 public:
  BoxProblem(const MatrixXd& D, const VectorXd& b, const VectorXd& low, const VectorXd& high,
             const VectorXd& rounding)
      : D_(D),
        b_(b),
        low_(low),
        high_(high),
        x_(VectorXd::Zero(b.size()).cwiseMax(low).cwiseMin(high)),
        bounded_((high - low).array().isFinite().cast<double>()),
        held_(static_cast<std::size_t>(b.size()), false) {
    const VectorXd w = b + D * x_;
    for (Index i = 0; i < w.size(); ++i)
      if (low[i] < high[i])
        zero_ = std::max({zero_, box_zero * std::abs(w[i]), box_zero * std::abs(b[i]), rounding[i]});
  }

  bool solve() {
    for (Index tries = 50 * (b_.size() + 1); tries > 0; --tries) {
      const std::optional<Index> i = wrong();
      if (!i) return true;
      if (!move(*i)) return false;
    }
    return false;
  }
  BoxSolution solution() const { return {x_, D_ * x_ + b_, held_}; }

 private:
  // Which way row i must go: 1, -1, or 0 where it is right, to what rounding leaves of bounded pushes.
  int way(Index i, double w) const {
    const double zero =
        std::max(zero_, sum_zero * D_.row(i).cwiseAbs().dot(bounded_.cwiseProduct(x_.cwiseAbs())));
    if (w < -zero && x_[i] < high_[i]) return 1;
    if (w > zero && x_[i] > low_[i]) return -1;
    return 0;
  }
  std::optional<Index> wrong() const {
    const VectorXd w = D_ * x_ + b_;
    std::optional<Index> worst;
    for (Index i = 0; i < w.size(); ++i)
      if (!held_[static_cast<std::size_t>(i)] && way(i, w[i]) != 0 &&
          (!worst || std::abs(w[i]) > std::abs(w[*worst])))
        worst = i;
    return worst;
  }

  // False where nothing stops it.
  bool move(Index i) {
    for (Index passes = 2 * b_.size() + 2; passes > 0; --passes) {
      const double w = D_.row(i).dot(x_) + b_[i];
      const int sense = way(i, w);
      if (sense == 0) return true;
      const VectorXd d = sense * past_held(D_, held_, i);
      const double bend = sense * D_.row(i).dot(d);
      double length = bend > box_dependent * D_(i, i) ? std::abs(w) / bend : unbounded;
      Index blocks = -1;
      for (Index k = 0; k < d.size(); ++k) {
        const double room = d[k] > 0   ? (high_[k] - x_[k]) / d[k]
                            : d[k] < 0 ? (low_[k] - x_[k]) / d[k]
                                       : unbounded;
        if (room < length) length = std::max(room, 0.0), blocks = k;
      }
      if (!std::isfinite(length)) return false;
      x_ += length * d;
      if (blocks < 0) return held_[static_cast<std::size_t>(i)] = true;
      x_[blocks] = d[blocks] > 0 ? high_[blocks] : low_[blocks];
      held_[static_cast<std::size_t>(blocks)] = false;
      if (blocks == i) return true;
    }
    return true;
  }

  const MatrixXd& D_;
  const VectorXd &b_, &low_, &high_;
  VectorXd x_, bounded_;  // 1 where both bounds are finite, else 0
  std::vector<bool> held_;
  double zero_ = 0;  // by rows that have a choice: others may be measured where they hardly move
};

}  // namespace

bool independent(const MatrixXd& D, const std::vector<bool>& held, Index i) {
  return D(i, i) > 0 && D.row(i).dot(past_held(D, held, i)) > box_dependent * D(i, i);
}

// In units in which the diagonal of D is 1; rows without any have no say.
std::optional<BoxSolution> solve_box(const MatrixXd& D, const VectorXd& b, const VectorXd& low,
                                     const VectorXd& high, const VectorXd& rounding) {
  VectorXd unit(b.size());
  for (Index i = 0; i < b.size(); ++i) unit[i] = D(i, i) > 0 ? std::sqrt(D(i, i)) : 1.0;
  const VectorXd inverse = unit.cwiseInverse();
  const MatrixXd scaled = inverse.asDiagonal() * D * inverse.asDiagonal();
  const VectorXd scaled_b = b.cwiseProduct(inverse), scaled_low = low.cwiseProduct(unit),
                 scaled_high = high.cwiseProduct(unit);
  BoxProblem problem(
      scaled, scaled_b, scaled_low, scaled_high,
      rounding.size() > 0 ? VectorXd(rounding.cwiseProduct(inverse)) : VectorXd::Zero(b.size()));
  if (!problem.solve()) return std::nullopt;
  BoxSolution out = problem.solution();
  out.x = out.x.cwiseProduct(inverse).cwiseMax(low).cwiseMin(high);
  out.w = out.w.cwiseProduct(unit);
  return out;
}

namespace {

// Of a change of x by which no w of a held row changes: row k, beside what rounding makes of that of i.
bool changes(const MatrixXd& D, const VectorXd& d, Index k, Index i) {
  return k != i && std::abs(d[k]) * std::sqrt(D(k, k)) > box_dependent * std::abs(d[i]) * std::sqrt(D(i, i));
}

void exchange(BoxSolution& solution, Index out, Index in) {
  solution.held[static_cast<std::size_t>(out)] = false;
  solution.held[static_cast<std::size_t>(in)] = true;
}

}  // namespace

void give_over(const MatrixXd& D, const std::vector<bool>& pushes, Index i, BoxSolution& solution) {
  const VectorXd d = -solution.x[i] * past_held(D, solution.held, i);
  double most = 1;
  Index out = -1;
  for (Index k = 0; k < d.size(); ++k)
    if (pushes[static_cast<std::size_t>(k)] && d[k] < 0 && changes(D, d, k, i) &&
        -solution.x[k] / d[k] < most)
      most = -solution.x[k] / d[k], out = k;
  solution.x += most * d;
  if (out >= 0) exchange(solution, out, i);
}

void take_over(const MatrixXd& D, const VectorXd& low, const VectorXd& high, const std::vector<bool>& pushes,
               Index i, BoxSolution& solution) {
  const VectorXd d = past_held(D, solution.held, i);
  double most = unbounded;
  Index spared = -1;
  for (Index k = 0; k < d.size(); ++k) {
    if (!changes(D, d, k, i)) continue;
    const double x = solution.x[k];
    const bool relieved = d[k] * x < 0;
    const double room = std::abs(relieved ? x : (d[k] > 0 ? high[k] : low[k]) - x) / std::abs(d[k]);
    if (room < most) most = room, spared = relieved && !pushes[static_cast<std::size_t>(k)] ? k : -1;
  }
  if (spared < 0) return;
  solution.x += most * d;
  exchange(solution, spared, i);
}

std::vector<std::vector<Index>> joined_rows(const MatrixXd& D) {
  constexpr double rounding = 1e-9;
  std::vector<std::vector<Index>> sets;
  std::vector<bool> taken(static_cast<std::size_t>(D.rows()), false);
  const auto take = [&](Index r) {
    taken[static_cast<std::size_t>(r)] = true;
    sets.back().push_back(r);
  };
  for (Index first = 0; first < D.rows(); ++first) {
    if (taken[static_cast<std::size_t>(first)]) continue;
    sets.emplace_back();
    take(first);
    for (std::size_t k = 0; k < sets.back().size(); ++k) {
      const Index of = sets.back()[k];
      for (Index r = 0; r < D.rows(); ++r)
        if (!taken[static_cast<std::size_t>(r)] &&
            std::abs(D(r, of)) > rounding * std::sqrt(D(r, r) * D(of, of)))
          take(r);
    }
  }
  return sets;
}

}  // namespace unfurl
