// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/saddle_solver.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/interleaved.hpp"

namespace unfurl {

std::vector<int> minimum_degree_order(const SparseRows& upper) {
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> full = upper.selfadjointView<Eigen::Upper>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(full, inverse);  // inverse.indices()[k]: the row eliminated k-th
  return {inverse.indices().data(), inverse.indices().data() + inverse.indices().size()};
}

namespace {

// Approximate minimum degree, then every constraint is moved behind the coordinates that it acts on. A
// constraint eliminated before them would bring the pivot -e, and with it growth by 1/e; behind them its
// pivot is of order one unless the constraint is truly redundant.
std::vector<int> elimination_order(const SparseRows& upper, const SparseRows& G) {
  const int n = static_cast<int>(G.cols()), size = static_cast<int>(upper.rows());
  std::vector<int> open(static_cast<std::size_t>(size - n), 0);
  std::vector<std::vector<int>> acting(static_cast<std::size_t>(n));
  for (int r = 0; r < G.outerSize(); ++r)
    for (SparseRows::InnerIterator it(G, r); it; ++it) {
      ++open[static_cast<std::size_t>(r)];
      acting[static_cast<std::size_t>(it.col())].push_back(r);
    }
  std::vector<char> waiting(open.size(), 0);
  std::vector<int> order;
  order.reserve(static_cast<std::size_t>(size));
  for (const int row : minimum_degree_order(upper)) {
    if (row >= n) {
      const auto c = static_cast<std::size_t>(row - n);
      if (open[c] == 0)
        order.push_back(row);
      else
        waiting[c] = 1;
      continue;
    }
    order.push_back(row);
    for (int c : acting[static_cast<std::size_t>(row)])
      if (--open[static_cast<std::size_t>(c)] == 0 && waiting[static_cast<std::size_t>(c)])
        order.push_back(n + c);
  }
  return order;
}

}  // namespace

SaddleSolver::SaddleSolver(const SparseRows& M, const SparseRows& G, int max_columns, double regularisation)
    : n_(M.rows()),
      m_(G.rows()),
      column_scale_(M.rows()),
      row_scale_(VectorXd::Ones(G.rows())),
      regularisation_(regularisation) {
  for (Index i = 0; i < n_; ++i) column_scale_[i] = 1.0 / std::sqrt(M.coeff(i, i));
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < M.outerSize(); ++r)
    for (SparseRows::InnerIterator it(M, r); it; ++it)
      if (it.col() >= r)
        entries.emplace_back(r, it.col(), column_scale_[r] * it.value() * column_scale_[it.col()]);
  for (int r = 0; r < G.outerSize(); ++r) {
    for (SparseRows::InnerIterator it(G, r); it; ++it) entries.emplace_back(it.col(), n_ + r, 1.0);
    entries.emplace_back(n_ + r, n_ + r, -regularisation);
  }
  SparseRows upper(n_ + m_, n_ + m_);
  upper.setFromTriplets(entries.begin(), entries.end());
  ldlt_.analyse(upper, elimination_order(upper, G));
  values_.assign(upper.valuePtr(), upper.valuePtr() + upper.nonZeros());
  for (int r = 0; r < G.outerSize(); ++r)
    for (SparseRows::InnerIterator it(G, r); it; ++it) {
      const int* begin = upper.innerIndexPtr() + upper.outerIndexPtr()[it.col()];
      const int* end = upper.innerIndexPtr() + upper.outerIndexPtr()[it.col() + 1];
      jacobian_place_.push_back(
          static_cast<int>(std::lower_bound(begin, end, static_cast<int>(n_ + r)) - upper.innerIndexPtr()));
    }
  place_.resize(static_cast<std::size_t>(n_ + m_));
  for (std::size_t k = 0; k < place_.size(); ++k)
    place_[static_cast<std::size_t>(ldlt_.order()[k])] = static_cast<int>(k);
  packed_.assign(static_cast<std::size_t>((n_ + m_) * max_columns), 0.0);
  for (VectorXd* v : {&rhs_, &best_, &try_}) v->setZero(n_ + m_);
}

bool SaddleSolver::factorise(const SparseRows& G) {
  fine_ready_ = false;
  const int* start = G.outerIndexPtr();
  const int* column = G.innerIndexPtr();
  const double* from = G.valuePtr();
  const int* const place = jacobian_place_.data();
  for (int r = 0, rows = static_cast<int>(m_); r < rows; ++r) {
    double square = 0;
    for (int p = start[r]; p < start[r + 1]; ++p) {
      const double value = from[p] * column_scale_[column[p]];
      square += value * value;
      values_[static_cast<std::size_t>(place[p])] = value;
    }
    row_scale_[r] = square > 0 ? 1.0 / std::sqrt(square) : 1.0;
    for (int p = start[r]; p < start[r + 1]; ++p)
      values_[static_cast<std::size_t>(place[p])] *= row_scale_[r];
  }
  return ldlt_.factorise(values_.data());
}

void SaddleSolver::apply(double* f, double* g, int columns) const {
  if (fine_ready_) return apply_finely(f, g, columns);
  with_columns(columns, [&](auto k) {
    constexpr int K = k();
    double* const b = packed_.data();
    const int* const place = place_.data();
    const auto gather = [&](const double* x, const VectorXd& scale, const int* to) {
      for (Index i = 0, size = scale.size(); i < size; ++i)
        (scale[i] * Lanes<K>(x + i * K)).store(b + static_cast<Index>(to[i]) * K);
    };
    const auto scatter = [&](double* x, const VectorXd& scale, const int* from) {
      for (Index i = 0, size = scale.size(); i < size; ++i)
        (scale[i] * Lanes<K>(b + static_cast<Index>(from[i]) * K)).store(x + i * K);
    };
    gather(f, column_scale_, place);
    gather(g, row_scale_, place + n_);
    ldlt_.solve_ordered(b, K);
    scatter(f, column_scale_, place);
    scatter(g, row_scale_, place + n_);
  });
}

double SaddleSolver::residual_norm(const double* r) const {
  double f = 0, g = 0;
  const int* place = place_.data();
  for (Index i = 0; i < n_; ++i, ++place) f += r[*place] * r[*place];
  for (Index i = 0; i < m_; ++i, ++place) g += r[*place] * r[*place];
  return std::sqrt(f) + std::sqrt(g);
}

// Refinement in scaled unknowns: x += K_e^{-1} (b - K_0 x), keeping the best iterate; it stops when the
// residual no longer halves, which round-off and inconsistent right-hand sides bring about.
double SaddleSolver::solve(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y,
                           int max_refinements) const {
  if (fine_ready_) {
    solve_finely(f, g, x, y);
    return 0.0;
  }
  double* const r = packed_.data();
  const int* const coordinate = place_.data();
  const int* const row = place_.data() + n_;
  for (Index i = 0; i < n_; ++i) rhs_[coordinate[i]] = f[i] * column_scale_[i];
  for (Index i = 0; i < m_; ++i) rhs_[row[i]] = g[i] * row_scale_[i];
  const double size = std::max(residual_norm(rhs_.data()), 1e-300);
  if (!std::isfinite(size)) {
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    y.setConstant(std::numeric_limits<double>::quiet_NaN());
    return size;
  }
  best_.setZero();
  try_.setZero();
  double best = 2.0 * size;
  for (int it = 0; it <= max_refinements + 1; ++it) {
    std::copy(rhs_.begin(), rhs_.end(), r);
    if (it > 0) {
      ldlt_.subtract_product(values_.data(), try_.data(), r);
      for (Index i = 0; i < m_; ++i) r[row[i]] -= regularisation_ * try_[row[i]];  // K_0 = K_e + e I there
    }
    const double residual = residual_norm(r);
    if (!(residual < best)) break;
    const bool slow = residual > 0.5 * best;
    best = residual;
    best_ = try_;
    if (it > 0 && (slow || residual <= 2e-16 * size)) break;
    ldlt_.solve_ordered(r, 1);
    for (Index i = 0; i < n_ + m_; ++i) try_[i] += r[i];
  }
  for (Index i = 0; i < n_; ++i) x[i] = best_[coordinate[i]] * column_scale_[i];
  for (Index i = 0; i < m_; ++i) y[i] = best_[row[i]] * row_scale_[i];
  return best / size;
}

}  // namespace unfurl
