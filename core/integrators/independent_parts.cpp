// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/independent_parts.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

IndependentParts::IndependentParts(const System& system) : sets_(system.solved_coordinates()) {
  const SparseRows G = system.jacobian_pattern();
  sets_.join_rows_of(system.mass());
  sets_.join_rows_of(G);
  for (int r = 0; r < G.outerSize(); ++r) {
    const SparseRows::InnerIterator it(G, r);
    first_.push_back(it ? it.col() : 0);
  }
  number();
}

void IndependentParts::join(const SparseRows& rows) {
  if (!several()) return;
  sets_.join_rows_of(rows);
  number();
}

void IndependentParts::join_by_forces(const System& system, double t, const VectorXd& q, const VectorXd& v) {
  if (!several() || system.constant_forces()) return;
  ForceDerivatives found;  // with zeros of what is slack
  system.force_derivatives(t, q, v, found);
  sets_.join_rows_of(found.by_z.sum());
  sets_.join_rows_of(found.by_w.sum());
  number();
}

void IndependentParts::number() {
  const Index n = sets_.size();
  std::vector<Index> number_of(static_cast<std::size_t>(n), -1);
  part_.assign(static_cast<std::size_t>(std::max<Index>(n, 1)), 0);  // rows without coordinates have one
  count_ = 0;
  for (Index i = 0; i < n; ++i) {
    Index& number = number_of[static_cast<std::size_t>(sets_.set_of(i))];
    if (number < 0) number = count_++;
    part_[static_cast<std::size_t>(i)] = number;
  }
  count_ = std::max<Index>(count_, 1);
}

VectorXd IndependentParts::largest(const double* x, Index columns) const {
  VectorXd out = VectorXd::Zero(count_);
  for (Index i = 0; i < sets_.size(); ++i)
    for (Index k = 0; k < columns; ++k) out[of(i)] = std::max(out[of(i)], std::abs(x[i * columns + k]));
  return out;
}

VectorXd IndependentParts::largest_of_rows(const VectorXd& x) const {
  VectorXd out = VectorXd::Zero(count_);
  for (Index r = 0; r < x.size(); ++r) out[of_row(r)] = std::max(out[of_row(r)], std::abs(x[r]));
  return out;
}

VectorXd IndependentParts::largest_beside(const VectorXd& x) const {
  const VectorXd of_parts = largest_of_rows(x);
  VectorXd out(x.size());
  for (Index r = 0; r < out.size(); ++r) out[r] = of_parts[of_row(r)];
  return out;
}

VectorXd IndependentParts::spread(const VectorXd& of_parts) const {
  VectorXd out(sets_.size());
  for (Index i = 0; i < out.size(); ++i) out[i] = of_parts[of(i)];
  return out;
}

}  // namespace unfurl
