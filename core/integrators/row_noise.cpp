// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/row_noise.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

RowNoise::RowNoise(const System& system) : system_(system), pattern_(system.jacobian_pattern()) {}

void RowNoise::start(const ConstVec& q) {
  VectorXd reach(system_.solved_coordinates());
  system_.reduce_sizes(q, reach);
  start_with(reach);
}

void RowNoise::start_with(const VectorXd& reach_of_each) {
  size_.setZero(system_.solved_coordinates());
  reach_ = reach_of_each;
  const VectorXd& lengths = system_.constraint_lengths();
  far_.resize(lengths.size());
  for (Index r = 0; r < lengths.size(); ++r) far_[r] = std::max(1.0, reach(r) / lengths[r]);
}

void RowNoise::add_forces(const ConstVec& f) {
  reduced_.resize(size_.size());
  system_.reduce_sizes(f, reduced_);
  size_ += reduced_;
}

double RowNoise::reach(Index r) const {
  double most = 0;
  for (SparseRows::InnerIterator it(pattern_, r); it; ++it) most = std::max(most, reach_[it.col()]);
  return most;
}

void RowNoise::add_multipliers(const ConstVec& lambda, double scale) {
  for (Index r = 0; r < lambda.size(); ++r) add_multiplier(r, std::abs(scale * lambda[r]));
}

void RowNoise::add_products(const SparseRows& A, const ConstVec& x, double scale) {
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseRows::InnerIterator it(A, i); it; ++it) size_[i] += std::abs(scale * it.value() * x[it.col()]);
}

VectorXd rate_bounds(const SparseRows& A, const VectorXd& m) {
  VectorXd sums = VectorXd::Zero(A.rows());
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseRows::InnerIterator it(A, i); it; ++it)
      sums[i] += std::abs(it.value()) / std::sqrt(m[i] * m[it.col()]);
  return sums;
}

double largest_of_moving(const SparseRows& A, const VectorXd& m) {
  double most = 0;
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseRows::InnerIterator it(A, i); it; ++it)
      if (std::isfinite(m[i] * m[it.col()])) most = std::max(most, std::abs(it.value()));
  return most;
}

double rate_bound(const SparseRows& A, const VectorXd& m) {
  const VectorXd sums = rate_bounds(A, m);
  double most = 0;
  for (const double sum : sums) most = std::max(most, sum);
  return most;
}

}  // namespace unfurl
