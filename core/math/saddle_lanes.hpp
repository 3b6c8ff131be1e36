// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "core/math/saddle_solver.hpp"

namespace unfurl {

// Several saddle-point systems of one pattern at once, such as those at the states of a run: one in each
// lane. Indices are walked once for all of them, and a lane's numbers go through the same operations in the
// same order as in a SaddleSolver of its own: its bits do not depend on what the others hold.
class SaddleLanes {
 public:
  static constexpr int lanes = 4;
  using Vectors = std::array<VectorXd, lanes>;

  // Of the same M, pattern and regularisation as `alone`, which must outlive it.
  explicit SaddleLanes(const SaddleSolver& alone);

  void set(int lane, const SparseRows& G);  // same pattern; a lane that was never set has zero rows
  void factorise();
  // Its factorisation held, and in the first order of `alone`: else solve() has nothing for it.
  bool ok(int lane) const { return ok_[static_cast<std::size_t>(lane)]; }
  // Whether SaddleSolver::shows_none_below would say so of the lane, in its first order. `alone`, of whose
  // factors the pivots alone are then right, is of no other use until something is handed over to it.
  [[nodiscard]] bool shows_none_below(int lane, double bound, SaddleSolver& alone) const;
  // `alone` becomes what it would be had it factorised the lane's matrix. False where that broke down.
  [[nodiscard]] bool hand_over(int lane, SaddleSolver& alone) const;
  using Norms = std::array<double, lanes>;
  // SaddleSolver::solve in every lane, whose refinements end when its own are done; the residuals.
  Norms solve(const Vectors& f, const Vectors& g, Vectors& x, Vectors& y, int max_refinements) const;

 private:
  static void take(const std::vector<double>& from, int lane, double* to);
  Norms residual_norms(const double* r) const;
  template <int width>
  void eliminate();
  void settle_pivot(std::size_t k, const double* own, double* d);
  template <int width>
  void solve_ordered(double* b) const;
  template <int width>
  void subtract_product(const double* x, double* r) const;

  const SaddleSolver& alone_;
  const SparseLdlt& ldlt_;  // of its first order, with the places there
  const int* place_;
  std::array<bool, lanes> ok_{};
  // As in SaddleSolver and SparseLdlt, entry by entry: entry i of lane c is x[i * lanes + c].
  std::vector<double> row_scale_, values_, l_, pivot_, inverse_pivot_, work_;
  std::vector<int> fill_;
  mutable std::vector<double> packed_, right_, best_, try_;
};

}  // namespace unfurl
