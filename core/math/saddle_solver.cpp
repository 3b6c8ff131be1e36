// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/saddle_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/math/interleaved.hpp"

namespace unfurl {

void SaddleSolver::Factors::analyse(const SparseRows& upper, const std::vector<int>& order) {
  ldlt.analyse(upper, order);
  place.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
}

// What a solver has of its matrix before there are numbers.
struct SaddleSolver::Analysis {
  Analysis(const SparseRows& mass, const SparseRows& jacobian, Order how, const VectorXd& column_scale);
  bool is_of(const SparseRows& mass, const SparseRows& jacobian, Order how) const {
    return (order == how || how == Order::safe) && same(M, mass) && same(G, jacobian);
  }
  static bool same(const SparseRows& a, const SparseRows& b) {
    const auto equal = [](const auto* x, const auto* y, Index size) { return std::equal(x, x + size, y); };
    return a.rows() == b.rows() && a.cols() == b.cols() && a.nonZeros() == b.nonZeros() &&
           equal(a.outerIndexPtr(), b.outerIndexPtr(), a.outerSize() + 1) &&
           equal(a.innerIndexPtr(), b.innerIndexPtr(), a.nonZeros()) &&
           equal(a.valuePtr(), b.valuePtr(), a.nonZeros());
  }
  // Of this thread: one model has several solvers at a time, and again and again. Of large ones the last.
  static std::shared_ptr<const Analysis> shared(const SparseRows& M, const SparseRows& G, Order order,
                                                const VectorXd& column_scale) {
    constexpr Index most_kept = 50000;  // entries of factors: a few MB
    thread_local std::array<std::shared_ptr<const Analysis>, 4> recent;
    thread_local std::shared_ptr<const Analysis> large;
    for (const auto& known : recent)
      if (known && known->is_of(M, G, order)) return known;
    if (large && large->is_of(M, G, order)) return large;
    auto made = std::make_shared<const Analysis>(M, G, order, column_scale);
    if (made->safe.ldlt.factor_nonzeros() > most_kept) return large = made;
    std::rotate(recent.begin(), recent.end() - 1, recent.end());
    return recent.front() = made;
  }

  SparseRows M, G;
  Order order;
  SparseRows upper;  // of K_e, but for e
  Factors safe;
  std::unique_ptr<Factors> sparse;
  std::vector<int> jacobian_place;
};

SaddleSolver::Analysis::Analysis(const SparseRows& mass, const SparseRows& jacobian, Order how,
                                 const VectorXd& column_scale)
    : M(mass), G(jacobian), order(how) {
  const Index n = M.rows(), m = G.rows();
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < M.outerSize(); ++r)
    for (SparseRows::InnerIterator it(M, r); it; ++it)
      if (it.col() >= r)
        entries.emplace_back(r, it.col(), column_scale[r] * it.value() * column_scale[it.col()]);
  for (int r = 0; r < G.outerSize(); ++r) {
    for (SparseRows::InnerIterator it(G, r); it; ++it) entries.emplace_back(it.col(), n + r, 1.0);
    entries.emplace_back(n + r, n + r, 0.0);
  }
  upper.resize(n + m, n + m);
  upper.setFromTriplets(entries.begin(), entries.end());
  const SaddleOrders orders = saddle_orders(upper, G * column_scale.asDiagonal());
  safe.analyse(upper, orders.safe);
  if (order == Order::sparse_first && orders.sparse != orders.safe) {
    sparse = std::make_unique<Factors>();
    sparse->analyse(upper, orders.sparse);
    if (sparse->ldlt.factor_nonzeros() >= safe.ldlt.factor_nonzeros()) sparse.reset();
  }
  for (int r = 0; r < G.outerSize(); ++r)
    for (SparseRows::InnerIterator it(G, r); it; ++it) {
      const int* begin = upper.innerIndexPtr() + upper.outerIndexPtr()[it.col()];
      const int* end = upper.innerIndexPtr() + upper.outerIndexPtr()[it.col() + 1];
      jacobian_place.push_back(
          static_cast<int>(std::lower_bound(begin, end, static_cast<int>(n + r)) - upper.innerIndexPtr()));
    }
}

SaddleSolver::SaddleSolver(const SparseRows& M, const SparseRows& G, int max_columns, double regularisation,
                           Order order)
    : n_(M.rows()),
      m_(G.rows()),
      column_scale_(M.rows()),
      row_scale_(VectorXd::Ones(G.rows())),
      regularisation_(regularisation) {
  for (Index i = 0; i < n_; ++i) column_scale_[i] = 1.0 / std::sqrt(M.coeff(i, i));
  const std::shared_ptr<const Analysis> known = Analysis::shared(M, G, order, column_scale_);
  safe_ = known->safe;
  if (known->sparse && order == Order::sparse_first) sparse_ = std::make_unique<Factors>(*known->sparse);
  jacobian_place_ = known->jacobian_place;
  const SparseRows& upper = known->upper;
  values_.assign(upper.valuePtr(), upper.valuePtr() + upper.nonZeros());
  for (Index r = n_; r < n_ + m_; ++r)
    values_[static_cast<std::size_t>(upper.outerIndexPtr()[r])] = -regularisation;
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
  return sparse_ ? first_serves(sparse_->ldlt.factorise(values_.data(), most_growth)) : factorise_safely();
}

bool SaddleSolver::factorise_safely() {
  in_use_ = &safe_;
  return safe_.ldlt.factorise(values_.data());
}

// Whether there are factors: those of the sparse order, if they held and did not grow.
bool SaddleSolver::first_serves(bool held) {
  in_use_ = sparse_.get();
  growth_ = held ? sparse_->ldlt.largest_pivot() : most_growth;
  return !grown(growth_) || factorise_safely();
}

// Of what shows a weak direction in the safe order, the pivots of rows, the sparse order shows smaller ones:
// their squares have fewer coordinates to add up over. Where a row has its own coordinate by a small entry
// only, it shows growth by the inverse.
bool SaddleSolver::shows_none_below(double bound) const {
  constexpr double margin = 2;
  Index below = 0;
  for (Index r = 0; r < m_; ++r) below += pivot_of_row(r) < margin * bound + 2 * regularisation_ ? 1 : 0;
  return below <= redundant_ && growth_ * margin * bound < 1;
}

void SaddleSolver::apply(double* f, double* g, int columns) const {
  if (fine_ready_) return apply_finely(f, g, columns);
  double* const b = packed_.data();
  const int* const place = in_use_->place.data();
  const auto gather = [columns, b](const double* x, const VectorXd& scale, const int* to) {
    with_wide_columns(columns, [=, s = scale.data(), size = scale.size()](auto k) {
      constexpr LaneCount K = k();
      for (Index i = 0; i < size; ++i) (s[i] * Lanes<K>(x + i * K)).store(b + static_cast<Index>(to[i]) * K);
    });
  };
  const auto scatter = [columns, b](double* x, const VectorXd& scale, const int* from) {
    with_wide_columns(columns, [=, s = scale.data(), size = scale.size()](auto k) {
      constexpr LaneCount K = k();
      for (Index i = 0; i < size; ++i)
        (s[i] * Lanes<K>(b + static_cast<Index>(from[i]) * K)).store(x + i * K);
    });
  };
  gather(f, column_scale_, place);
  gather(g, row_scale_, place + n_);
  in_use_->ldlt.solve_ordered(b, columns);
  scatter(f, column_scale_, place);
  scatter(g, row_scale_, place + n_);
}

double SaddleSolver::residual_norm(const double* r) const {
  double f = 0, g = 0;
  const int* place = in_use_->place.data();
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
  const int* const coordinate = in_use_->place.data();
  const int* const row = coordinate + n_;
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
      in_use_->ldlt.subtract_product(values_.data(), try_.data(), r);
      for (Index i = 0; i < m_; ++i) r[row[i]] -= regularisation_ * try_[row[i]];  // K_0 = K_e + e I there
    }
    const double residual = residual_norm(r);
    if (!(residual < best)) break;
    const bool slow = residual > 0.5 * best;
    best = residual;
    best_ = try_;
    if (it > 0 && (slow || residual <= 2e-16 * size)) break;
    in_use_->ldlt.solve_ordered(r, 1);
    for (Index i = 0; i < n_ + m_; ++i) try_[i] += r[i];
  }
  if (max_refinements < 0) best_ = try_;
  for (Index i = 0; i < n_; ++i) x[i] = best_[coordinate[i]] * column_scale_[i];
  for (Index i = 0; i < m_; ++i) y[i] = best_[row[i]] * row_scale_[i];
  return best / size;
}

// What no motion can bring about, r with G^T r = 0, stays; of others G^T r is seen down to round-off.
bool SaddleSolver::left_a_direction() const {
  constexpr double round_off = 1e-13;  // of the right-hand side
  const int* const row = in_use_->place.data() + n_;
  double* const r = packed_.data();
  std::copy(rhs_.begin(), rhs_.end(), r);
  in_use_->ldlt.subtract_product(values_.data(), best_.data(), r);
  try_.setZero();
  for (Index i = 0; i < m_; ++i) try_[row[i]] = r[row[i]] - regularisation_ * best_[row[i]];
  std::fill(packed_.begin(), packed_.end(), 0.0);
  in_use_->ldlt.subtract_product(values_.data(), try_.data(), r);
  for (Index i = 0; i < m_; ++i) r[row[i]] = 0;
  return residual_norm(r) > round_off * residual_norm(rhs_.data());
}

}  // namespace unfurl
