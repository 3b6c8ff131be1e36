#include "core/math/saddle_solver.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cmath>
#include <limits>

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
      M_(M),
      G_(G),
      column_scale_(M.rows()),
      row_scale_(VectorXd::Ones(G.rows())) {
  for (Index i = 0; i < n_; ++i) column_scale_[i] = 1.0 / std::sqrt(M.coeff(i, i));
  M_ = column_scale_.asDiagonal() * M * column_scale_.asDiagonal();
  M_.makeCompressed();
  G_.makeCompressed();
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < M_.outerSize(); ++r)
    for (SparseRows::InnerIterator it(M_, r); it; ++it)
      if (it.col() >= r) entries.emplace_back(r, it.col(), it.value());
  for (int r = 0; r < G_.outerSize(); ++r) {
    for (SparseRows::InnerIterator it(G_, r); it; ++it) entries.emplace_back(it.col(), n_ + r, 1.0);
    entries.emplace_back(n_ + r, n_ + r, -regularisation);
  }
  SparseRows upper(n_ + m_, n_ + m_);
  upper.setFromTriplets(entries.begin(), entries.end());
  ldlt_.analyse(upper, elimination_order(upper, G_));
  values_.assign(upper.valuePtr(), upper.valuePtr() + upper.nonZeros());
  for (int r = 0; r < G_.outerSize(); ++r)
    for (SparseRows::InnerIterator it(G_, r); it; ++it) {
      const int* begin = upper.innerIndexPtr() + upper.outerIndexPtr()[it.col()];
      const int* end = upper.innerIndexPtr() + upper.outerIndexPtr()[it.col() + 1];
      jacobian_place_.push_back(
          static_cast<int>(std::lower_bound(begin, end, static_cast<int>(n_ + r)) - upper.innerIndexPtr()));
    }
  packed_.assign(static_cast<std::size_t>((n_ + m_) * max_columns), 0.0);
  for (VectorXd* v : {&rhs_f_, &best_x_, &try_x_}) v->setZero(n_);
  for (VectorXd* v : {&rhs_g_, &best_y_, &try_y_}) v->setZero(m_);
}

bool SaddleSolver::factorise(const SparseRows& G) {
  const int* start = G.outerIndexPtr();
  const int* column = G.innerIndexPtr();
  const double* from = G.valuePtr();
  double* to = G_.valuePtr();
  for (int r = 0; r < G.outerSize(); ++r) {
    double square = 0;
    for (int p = start[r]; p < start[r + 1]; ++p) {
      to[p] = from[p] * column_scale_[column[p]];
      square += to[p] * to[p];
    }
    row_scale_[r] = square > 0 ? 1.0 / std::sqrt(square) : 1.0;
    for (int p = start[r]; p < start[r + 1]; ++p) {
      to[p] *= row_scale_[r];
      values_[static_cast<std::size_t>(jacobian_place_[static_cast<std::size_t>(p)])] = to[p];
    }
  }
  return ldlt_.factorise(values_.data());
}

void SaddleSolver::apply(double* f, double* g, int columns) const {
  double* const b = packed_.data();
  for (Index i = 0; i < n_; ++i)
    for (int c = 0; c < columns; ++c) b[i * columns + c] = f[i * columns + c] * column_scale_[i];
  double* const bg = b + n_ * columns;
  for (Index i = 0; i < m_; ++i)
    for (int c = 0; c < columns; ++c) bg[i * columns + c] = g[i * columns + c] * row_scale_[i];
  ldlt_.solve(b, columns);
  for (Index i = 0; i < n_; ++i)
    for (int c = 0; c < columns; ++c) f[i * columns + c] = b[i * columns + c] * column_scale_[i];
  for (Index i = 0; i < m_; ++i)
    for (int c = 0; c < columns; ++c) g[i * columns + c] = bg[i * columns + c] * row_scale_[i];
}

// Refinement in scaled unknowns: x += K_e^{-1} (b - K_0 x), keeping the best iterate; it stops when the
// residual no longer halves, which round-off and inconsistent right-hand sides bring about.
double SaddleSolver::solve(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y,
                           int max_refinements) const {
  const double size =
      std::max((f.cwiseProduct(column_scale_)).norm() + (g.cwiseProduct(row_scale_)).norm(), 1e-300);
  if (!std::isfinite(size)) {
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    y.setConstant(std::numeric_limits<double>::quiet_NaN());
    return size;
  }
  double* const b = packed_.data();
  best_x_.setZero();
  best_y_.setZero();
  try_x_.setZero();
  try_y_.setZero();
  double best = 2.0 * size;
  for (int it = 0; it <= max_refinements + 1; ++it) {
    rhs_f_ = f.cwiseProduct(column_scale_);
    rhs_g_ = g.cwiseProduct(row_scale_);
    if (it > 0) {
      rhs_f_.noalias() -= M_ * try_x_;
      rhs_f_.noalias() -= G_.transpose() * try_y_;
      rhs_g_.noalias() -= G_ * try_x_;
    }
    const double residual = rhs_f_.norm() + rhs_g_.norm();
    if (!(residual < best)) break;
    const bool slow = residual > 0.5 * best;
    best = residual;
    best_x_ = try_x_;
    best_y_ = try_y_;
    if (it > 0 && (slow || residual <= 1e-17 * size)) break;
    Eigen::Map<VectorXd>(b, n_) = rhs_f_;
    Eigen::Map<VectorXd>(b + n_, m_) = rhs_g_;
    ldlt_.solve(b, 1);
    try_x_ += Eigen::Map<VectorXd>(b, n_);
    try_y_ += Eigen::Map<VectorXd>(b + n_, m_);
  }
  x = best_x_.cwiseProduct(column_scale_);
  y = best_y_.cwiseProduct(row_scale_);
  return best / size;
}

}  // namespace unfurl
