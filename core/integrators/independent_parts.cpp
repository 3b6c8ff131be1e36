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

void IndependentParts::join_by_forces(const System& system, const State& state) {
  if (!several() || system.constant_forces()) return;
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  SparseRows by_z, by_w;
  system.force_derivatives(state.t, q, v, by_z, by_w);
  for (const SparseRows* A : {&by_z, &by_w}) sets_.join_rows_of(*A);
  number();
}

void IndependentParts::number() {
  const Index n = sets_.size();
  part_.resize(static_cast<std::size_t>(n));
  std::vector<Index> number_of(part_.size(), -1);
  count_ = 0;
  for (Index i = 0; i < n; ++i) {
    Index& number = number_of[static_cast<std::size_t>(sets_.set_of(i))];
    if (number < 0) number = count_++;
    part_[static_cast<std::size_t>(i)] = number;
  }
}

VectorXd IndependentParts::largest(const double* x, Index columns) const {
  VectorXd out = VectorXd::Zero(count_);
  for (Index i = 0; i < std::ssize(part_); ++i)
    for (Index k = 0; k < columns; ++k) out[of(i)] = std::max(out[of(i)], std::abs(x[i * columns + k]));
  return out;
}

VectorXd IndependentParts::largest_of_rows(const VectorXd& x) const {
  VectorXd out = VectorXd::Zero(count_);
  for (Index r = 0; r < x.size(); ++r) out[of_row(r)] = std::max(out[of_row(r)], std::abs(x[r]));
  return out;
}

VectorXd IndependentParts::spread(const VectorXd& of_parts) const {
  VectorXd out(std::ssize(part_));
  for (Index i = 0; i < out.size(); ++i) out[i] = of_parts[of(i)];
  return out;
}

}  // namespace unfurl
