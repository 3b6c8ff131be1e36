// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/full_newton.hpp"

#include <algorithm>
#include <limits>

#include "core/math/saddle_solver.hpp"

namespace unfurl {
namespace {

// The matrix, scaled: a small one entry by entry in its place, a larger one as a list of entries.
class Entries {
 public:
  Entries(const VectorXd& scale, MatrixXd* dense, std::vector<Eigen::Triplet<double>>& list)
      : scale_(scale), dense_(dense), list_(list) {
    if (dense_) dense_->setZero(scale.size(), scale.size());
    list_.clear();
  }
  void add(Index i, Index j, double value) { add_scaled(i, j, value * scale_[i] * scale_[j]); }
  void add_scaled(Index i, Index j, double value) {
    if (dense_)
      (*dense_)(i, j) += value;
    else
      list_.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
  }

 private:
  const VectorXd& scale_;
  MatrixXd* dense_;  // null: there is none
  std::vector<Eigen::Triplet<double>>& list_;
};

void add_block(Entries& entries, const SparseRows& A, Index row, Index column, double scale,
               bool transposed) {
  for (int r = 0; r < A.outerSize(); ++r)
    for (SparseRows::InnerIterator it(A, r); it; ++it) {
      const Index i = transposed ? it.col() : r, j = transposed ? r : it.col();
      entries.add(row + i, column + j, scale * it.value());
    }
}

// Rows and columns are scaled as in SaddleSolver: coordinates by 1/sqrt(M_ii), multipliers so that G has unit
// rows.
struct Scales {
  VectorXd coordinate, multiplier;
};

// 1 / |G_r D|
VectorXd row_scales(const SparseRows& G, const VectorXd& coordinate) {
  VectorXd scale(G.rows());
  for (int r = 0; r < G.outerSize(); ++r) {
    double square = 0;
    for (SparseRows::InnerIterator it(G, r); it; ++it)
      square += std::pow(it.value() * coordinate[it.col()], 2);
    scale[r] = square > 0 ? 1.0 / std::sqrt(square) : 1.0;
  }
  return scale;
}

Scales scales_of(const StageEquations& eq, const SparseRows& G) {
  Scales s{VectorXd(eq.dX.rows()), {}};
  for (Index i = 0; i < s.coordinate.size(); ++i)
    s.coordinate[i] = 1.0 / std::sqrt(eq.system.mass().coeff(i, i));
  s.multiplier = row_scales(G, s.coordinate);
  return s;
}

// h dr_k / dX_i of the forces that vary: h sum_j w_j l_k(tau_j) [h l_i(tau_j) dF/dz + l_i'(tau_j) dF/dz']
void add_force_blocks(Entries& entries, StageEquations& eq) {
  const Index n = eq.dX.rows();
  SparseRows by_z, by_w;
  for (Index j = 0; j < eq.c.tau.size(); ++j) {
    eq.force_derivatives(j, by_z, by_w);
    for (Index k = 0; k + 1 < eq.c.s; ++k)
      for (Index i = 1; i < eq.c.s; ++i) {
        const double weight = eq.h * eq.c.weight[j] * eq.c.value(k, j);
        add_block(entries, by_z, k * n, (i - 1) * n, weight * eq.h * eq.c.value(i, j), false);
        add_block(entries, by_w, k * n, (i - 1) * n, weight * eq.c.slope(i, j), false);
      }
  }
}

// Rows of multipliers: of every stage, or the one set of the variant with constraints at the ends.
Index multipliers(const StageEquations& eq) {
  return eq.lambda.rows() * (eq.at_ends ? 1 : eq.c.s - 1);
}

Index rod_unknowns(const StageEquations& eq) {
  return eq.rods.as_unknowns ? eq.rods.tension.size() : 0;
}

Index unknowns(const StageEquations& eq) {
  return (eq.c.s - 1) * eq.dX.rows() + multipliers(eq) + rod_unknowns(eq);
}

// In Y_j = -h^2 w_j dN_j: l_k(tau_j) D_j^T Y_j of row k, and of the rows at tau_j
//     sum_i [l_i(tau_j) dR/dz + l_i'(tau_j)/h dR/dz'] dX_i + C / (h^2 w_j) Y_j = -R_j.
//
// Forces F(N) that depend on N besides add -l_k(tau_j) dF/dN Y_j to row k.
void add_rod_blocks(Entries& entries, StageEquations& eq, Index first) {
  const Index n = eq.dX.rows(), count = eq.rods.tension.rows();
  const bool by_tension = eq.system.by_tension();
  SparseRows directions, by_z, by_w;
  for (Index j = 0; j < eq.c.tau.size(); ++j) {
    const Index rows = first + j * count;
    eq.rod_derivatives(j, directions, by_z, by_w);
    if (by_tension) directions -= SparseRows(eq.tension_derivatives(j).transpose());
    for (Index k = 0; k + 1 < eq.c.s; ++k)
      add_block(entries, directions, k * n, rows, eq.c.value(k, j), true);
    for (Index i = 1; i < eq.c.s; ++i) {
      add_block(entries, by_z, rows, (i - 1) * n, eq.c.value(i, j), false);
      add_block(entries, by_w, rows, (i - 1) * n, eq.c.slope(i, j) / eq.h, false);
    }
  }
}

// The diagonal C / (h^2 w_j) of the rods' rows, after scaling. Rods so stiff that they are redundant for the
// matrix count as a little less stiff there.
void add_compliances(Entries& entries, const StageEquations& eq, Index first, const VectorXd& scale) {
  constexpr double least = 1e-15;
  const Index count = eq.rods.tension.rows();
  for (Index j = 0; j < eq.c.tau.size(); ++j)
    for (Index i = 0; i < count; ++i) {
      const Index at = first + j * count + i;
      const double diagonal = eq.rods.compliance(i) / (eq.h * eq.h * eq.c.weight[j]);
      entries.add_scaled(at, at, std::max(diagonal * scale[at] * scale[at], least));
    }
}

void add_newton_matrix(StageEquations& eq, const VectorXd& scale, Entries& entries) {
  const Index n = eq.dX.rows(), m = eq.lambda.rows(), stages = eq.c.s - 1;
  SparseRows G = eq.system.jacobian_pattern();
  std::vector<double> scratch;
  for (Index k = 0; k < stages; ++k) {
    for (Index j = 0; j < stages; ++j)
      add_block(entries, eq.system.mass(), k * n, j * n, eq.c.C(k, j), false);
    if (eq.at_ends) continue;
    eq.system.jacobian(eq.Q.col(k), G, scratch);
    for (Index j = 0; j < stages; ++j) add_block(entries, G, k * n, stages * n + j * m, eq.c.C(k, j), true);
    if (k > 0) {
      const SparseRows H = eq.system.curvature(eq.Q.col(k), eq.lambda.col(k));
      add_block(entries, H, k * n, (k - 1) * n, -eq.h * eq.h * eq.c.b[k], false);
    }
    eq.system.jacobian(eq.Q.col(k + 1), G, scratch);
    add_block(entries, G, stages * n + k * m, k * n, 1.0, false);
  }
  if (eq.at_ends) {
    eq.system.jacobian(eq.Q.col(0), G, scratch);
    add_block(entries, G, 0, stages * n, 1.0, true);
    eq.system.jacobian(eq.Q.col(stages), G, scratch);
    add_block(entries, G, stages * n, (stages - 1) * n, 1.0, false);
  }
  const Index rods = stages * n + multipliers(eq);
  if (!eq.system.constant_forces()) add_force_blocks(entries, eq);
  for (Index i = stages * n; i < rods; ++i) entries.add_scaled(i, i, -SaddleSolver::standard_regularisation);
  if (!eq.rods.as_unknowns) return;
  add_rod_blocks(entries, eq, rods);
  add_compliances(entries, eq, rods, scale);
}

VectorXd right_hand_side(const StageEquations& eq) {
  const Index n = eq.dX.rows(), m = eq.lambda.rows(), stages = eq.c.s - 1,
              rods = stages * n + multipliers(eq);
  VectorXd b(unknowns(eq));
  for (Index k = 0; k < stages; ++k) {
    b.segment(k * n, n) = -eq.h * eq.momentum.col(k);
    if (!eq.at_ends) b.segment(stages * n + k * m, m) = -eq.phi.col(k);
  }
  if (eq.at_ends) b.segment(stages * n, m) = -eq.phi.col(stages - 1);
  if (eq.rods.as_unknowns) b.tail(b.size() - rods) = -eq.rods.residual.reshaped();
  return b;
}

void apply(StageEquations& eq, const VectorXd& x) {
  const Index n = eq.dX.rows(), m = eq.lambda.rows(), stages = eq.c.s - 1,
              rods = stages * n + multipliers(eq), count = eq.rods.tension.rows();
  for (Index j = 0; j < stages; ++j) {
    eq.dX.col(j) += x.segment(j * n, n);
    for (Index k = 0; k < stages && !eq.at_ends; ++k)
      eq.lambda.col(k) -= (eq.c.C(k, j) / (eq.h * eq.h * eq.c.b[k])) * x.segment(stages * n + j * m, m);
    if (eq.rods.as_unknowns)
      eq.rods.tension.col(j) -= x.segment(rods + j * count, count) / (eq.h * eq.h * eq.c.weight[j]);
  }
  if (eq.at_ends) eq.lambda.col(0) -= x.segment(stages * n, m) / (eq.h * eq.h * eq.multiplier_weight(0));
}

}  // namespace

bool FullNewton::Factors::compute(StageEquations& eq, const VectorXd& scale) {
  const bool small = scale.size() <= largest_dense;
  Entries entries(scale, small ? &matrix_ : nullptr, entries_);
  add_newton_matrix(eq, scale, entries);
  if (small) {
    dense_.compute(matrix_);
    return true;
  }
  assemble(scale.size());
  return sparse_.factorise(columns_);
}

// Entries come in the same order for the same pattern, which is then filled as it is.
void FullNewton::Factors::assemble(Index size) {
  const bool known = columns_.rows() == size && slots_.size() == entries_.size() &&
                     std::ranges::equal(slots_, entries_, [](const Slot& s, const auto& e) {
                       return s.row == e.row() && s.column == e.col();
                     });
  if (known) {
    std::fill_n(columns_.valuePtr(), columns_.nonZeros(), 0.0);
    for (std::size_t k = 0; k < slots_.size(); ++k) columns_.valuePtr()[slots_[k].at] += entries_[k].value();
    return;
  }
  columns_.resize(size, size);
  columns_.setFromTriplets(entries_.begin(), entries_.end());
  slots_.clear();
  for (const auto& e : entries_) {
    const int *first = columns_.innerIndexPtr() + columns_.outerIndexPtr()[e.col()],
              *end = columns_.innerIndexPtr() + columns_.outerIndexPtr()[e.col() + 1];
    slots_.push_back({e.row(), e.col(), std::lower_bound(first, end, e.row()) - columns_.innerIndexPtr()});
  }
  sparse_.analyse(columns_);
}

VectorXd FullNewton::Factors::solve(const VectorXd& b) const {
  return b.size() <= largest_dense ? dense_.solve(b) : sparse_.solve(b);
}

void FullNewton::set_scale(const StageEquations& eq) {
  const Index n = eq.dX.rows(), m = eq.lambda.rows(), stages = eq.c.s - 1,
              rods = stages * n + multipliers(eq), count = eq.rods.tension.rows();
  SparseRows G = eq.system.jacobian_pattern();
  std::vector<double> scratch;
  eq.system.jacobian(eq.Q.col(0), G, scratch);
  const Scales s = scales_of(eq, G);
  scale_.resize(unknowns(eq));
  for (Index k = 0; k < stages; ++k) scale_.segment(k * n, n) = s.coordinate;
  for (Index at = stages * n; m > 0 && at < rods; at += m) scale_.segment(at, m) = s.multiplier;
  if (!eq.rods.as_unknowns) return;
  const VectorXd of_rods = row_scales(eq.system.giving_rod_directions(eq.Q.col(0)), s.coordinate);
  for (Index at = rods; at < scale_.size(); at += count) scale_.segment(at, count) = of_rods;
}

StepStatus FullNewton::solve(StageEquations& eq, double wanted, double accepted, bool keep,
                             StepReport& report) {
  constexpr int max_iterations = 20;
  constexpr double quick = 0.1;  // residuals that fall below this share of the last one keep their matrix
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool kept = keep && known_ && h_ == eq.h;
  known_ = false;
  if (!kept) set_scale(eq);
  h_ = eq.h;
  double best = infinity, before = kept ? infinity : 0;
  int without_gain = 0;
  for (int it = 0; it <= max_iterations; ++it) {
    eq.evaluate();
    const double level = eq.level();
    report.residual = level;
    known_ = keep && std::isfinite(level) && (it > 0 || kept);
    if (level <= wanted) return StepStatus::converged;
    if (!std::isfinite(level)) return StepStatus::not_finite;
    if (level < 0.5 * best) {
      best = level;
      without_gain = 0;
    } else if (++without_gain >= 3) {
      if (level <= accepted) return StepStatus::converged;
      if (keep || !eq.look_at_turned_forces()) return StepStatus::stalled;
      without_gain = 0;
    }
    if (it == max_iterations) break;
    ++report.newton_iterations;
    if (!(level < quick * before)) {
      ++report.factorisations;
      if (!factors_.compute(eq, scale_)) return known_ = false, StepStatus::diverged;
    }
    before = level;
    const VectorXd x = factors_.solve(scale_.cwiseProduct(right_hand_side(eq)));
    apply(eq, scale_.cwiseProduct(x));
    report.right_hand_sides += static_cast<int>(eq.c.s - 1);
  }
  known_ = false;
  return StepStatus::stalled;
}

}  // namespace unfurl
