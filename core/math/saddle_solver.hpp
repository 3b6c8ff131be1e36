// SPDX-License-Identifier: BSD-3-Clause
// The saddle-point system of constrained mechanics,
//
//     [ M  G^T ] [x]   [f]
//     [ G   0  ] [y] = [g]
//
// for redundant and rank-losing G. It is solved in scaled unknowns, M^ = D M D with unit diagonal and rows of
// G^ = R G D of unit length, through the quasi-definite K_e = [M^ G^^T; G^ -e I], which has an L D L^T in
// every order. The rows of G whose singular value is far above sqrt(e) are solved to round-off by a
// refinement or two; directions in which G has no rank get the multiplier of least (scaled) norm, namely
// none.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/math/saddle_order.hpp"
#include "core/math/sparse_ldlt.hpp"
#include "core/math/types.hpp"

namespace unfurl {

class SaddleSolver {
 public:
  // In which order unknowns are eliminated (core/math/saddle_order.hpp): the safe one, or the sparse one as
  // long as no pivot grows much and the safe one where it does.
  enum class Order { safe, sparse_first };

  // M: constant, symmetric, positive diagonal. G: its pattern; the sparse order goes by its values, too.
  // max_columns: right-hand sides that one call to solve may bring. A larger regularisation suppresses
  // round-off in multipliers that are not unique (it is 1e-16 / e) and needs more refinements for directions
  // of small singular values.
  SaddleSolver(const SparseRows& M, const SparseRows& G, int max_columns = 1,
               double regularisation = standard_regularisation, Order order = Order::safe);
  SaddleSolver(const SaddleSolver&) = delete;
  SaddleSolver& operator=(const SaddleSolver&) = delete;

  // Numeric factorisation with the values of G (same pattern). False where it broke down.
  [[nodiscard]] bool factorise(const SparseRows& G);

  // The smallest pivot of a row of G that no redundant row explains, about the square of the smallest
  // singular value of G^; looked for below `bound` only, which is returned where there is none. Pivots that
  // regularisation or round-off hide are found by factorise_finely, whose factors are then in use. The sparse
  // order is left where it cannot tell.
  double weakest_pivot(double bound);
  bool may_be_below(Index r, double bound) const;  // row r by itself, which may be redundant
  // How many rows have a smaller pivot, as far as the factors in use tell: all that have, and redundant ones
  // that depend on few others. And by factors in twice the digits, which are in use then where a row is weak.
  Index rows_below(double bound) const;
  // No row depends on others, and no pivot is below `least`, by factors in twice the digits, which are in use
  // then. Where doubles show a row that does, it is not looked any closer.
  bool all_independent(double least);
  Index rows_below_finely(double bound);
  // As many rows as G^ has singular values below `bound` (1e-13 and more), counted in twice the digits by the
  // inertia of K_e with e = -bound^2 (Sylvester), which no pivots in between can spoil: `guess` where it has
  // that size, otherwise those of which the rows before them in the order of elimination leave least, in
  // rising order.
  std::vector<int> dependent_rows(double bound, const std::vector<int>& guess);
  // False where a row that is not known to be redundant may have a smaller one, by the factors in use. Of a
  // row that depends on others, c of each, they have e (1 + |c|^2): in doubt, ask for many e.
  bool shows_none_below(double bound) const;

  // The same matrix again in twice the digits and with e = 1e-23, which apply and solve use from then on
  // until the next factorise: L D L^T squares singular values, so doubles see none below sqrt(e) or 1e-8.
  // Directions down to 1e-10 are resolved, rows below that count as redundant and get multipliers of least
  // norm. Slow. False where it broke down.
  [[nodiscard]] bool factorise_finely();
  bool fine() const { return fine_ready_; }
  // Neither growth nor a weak direction has called for other factors than the first ones.
  bool in_first_order() const { return in_use_ == &first() && !fine_ready_; }

  // The largest motion [m] that answers a row's error [m], but for the singular values of G^.
  double motion_of_error() const;
  const VectorXd& row_scale() const { return row_scale_; }        // R
  const VectorXd& column_scale() const { return column_scale_; }  // D

  // One application of K_e^{-1}, no refinement: right for the corrections of an iteration that computes its
  // own residuals. f [n], g [m] are overwritten by x, y; row by row for several columns: f[i * columns + c].
  void apply(double* f, double* g, int columns) const;

  // Solve to round-off with iterative refinement on the true system; x and y may not alias f and g.
  // Returns the last residual, relative to the right-hand side and in the scaled norm. max_refinements -1: as
  // one application leaves it, with no residual looked at (1 is returned). A right-hand side that
  // is not finite, or whose norm overflows, gives NaN everywhere.
  double solve(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y, int max_refinements = 8) const;

  // x of f = 0 alone, in twice the digits (fine()), for a third less.
  void solve_motion(const ConstVec& g, MutVec x) const;

  // Whether what the last solve left is of a direction that the rows do reach: of a singular value below
  // sqrt(e) refinement takes less than a half, and is given up, as it is where right-hand sides contradict
  // each other.
  bool left_a_direction() const;

  Index factor_nonzeros() const { return first().ldlt.factor_nonzeros(); }
  static constexpr double standard_regularisation = 1e-13;  // e, in the scaled unknowns

 private:
  friend class SaddleLanes;
  struct Factors {
    SparseLdlt ldlt;
    std::vector<int> place;  // of each row in the order of elimination
    void analyse(const SparseRows& upper, const std::vector<int>& order);
  };
  struct Analysis;
  const Factors& first() const { return sparse_ ? *sparse_ : safe_; }
  bool factorise_safely();
  bool first_serves(bool held);
  double residual_norm(const double* r) const;
  std::size_t place_of_row(Index r, const Factors& factors) const {
    return static_cast<std::size_t>(factors.place[static_cast<std::size_t>(n_ + r)]);
  }
  double pivot_of_row(Index r) const {
    return std::abs(in_use_->ldlt.pivot(static_cast<Index>(place_of_row(r, *in_use_))));
  }
  static constexpr double most_growth = 1e7;
  static bool grown(double largest_pivot) { return !(largest_pivot < most_growth); }
  void apply_finely(double* f, double* g, int columns) const;
  void solve_finely(const ConstVec& f, const ConstVec& g, MutVec x, MutVec y, int most_passes = 10) const;

  Index n_ = 0, m_ = 0;
  VectorXd column_scale_, row_scale_;  // D, R
  Factors safe_;
  std::unique_ptr<Factors> sparse_;  // null: not asked for, or of no use
  const Factors* in_use_ = &safe_;
  double growth_ = 1;                // the largest pivot of a coordinate, in the sparse order
  double regularisation_;            // e
  std::vector<double> values_;       // upper triangle of K_e
  std::vector<int> jacobian_place_;  // where each entry of G goes in values_
  // Unknowns and right-hand sides, in the order of elimination.
  mutable std::vector<double> packed_;
  mutable VectorXd rhs_, best_, try_;

  struct Fine;  // the factors in twice the digits
  struct FineDelete {
    void operator()(Fine* fine) const;
  };
  std::unique_ptr<Fine, FineDelete> fine_;
  bool fine_ready_ = false;  // fine_ holds the present matrix
  Index redundant_ = 0;      // rows that depend on others, by the last fine factorisation
  double weakest_ = 1.0;     // the smallest pivot of the other rows, there
  std::vector<Index> by_pivot_;
};

}  // namespace unfurl
