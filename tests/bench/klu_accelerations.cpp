// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/klu_accelerations.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace unfurl::bench {

KluAccelerations::KluAccelerations(const System& system, const ConstVec& q, bool pivoting)
    : system_(system), pivoting_(pivoting), G_(system.jacobian_pattern()), q_(q), v_(q.size()), f_(q.size()) {
  pick_rows(q);
  const Index n = system.solved_coordinates(), size = n + static_cast<Index>(rows_.size());
  matrix_.resize(size, size);
  fill();
  klu_defaults(&common_);
  symbolic_ = klu_analyze(static_cast<int>(size), matrix_.outerIndexPtr(), matrix_.innerIndexPtr(), &common_);
  numeric_ =
      klu_factor(matrix_.outerIndexPtr(), matrix_.innerIndexPtr(), matrix_.valuePtr(), symbolic_, &common_);
  if (!numeric_) throw std::runtime_error("KLU cannot factorise the index-1 matrix");
  b_.resize(size);
  bias_.resize(system.constraints());
  force_.resize(n);
}

KluAccelerations::~KluAccelerations() {
  klu_free_numeric(&numeric_, &common_);
  klu_free_symbolic(&symbolic_, &common_);
}

void KluAccelerations::pick_rows(const ConstVec& q) {
  system_.jacobian(q, G_, scratch_);
  Eigen::ColPivHouseholderQR<MatrixXd> qr(MatrixXd(G_).transpose());
  qr.setThreshold(1e-9);
  for (Index i = 0; i < qr.rank(); ++i) rows_.push_back(qr.colsPermutation().indices()[i]);
  std::sort(rows_.begin(), rows_.end());
}

// [M G^T; G 0], the same pattern every time; places_ remembers where the entries of G go.
void KluAccelerations::fill() {
  const Index n = system_.solved_coordinates();
  std::vector<Eigen::Triplet<double>> entries;
  const SparseRows& M = system_.mass();
  for (int r = 0; r < M.outerSize(); ++r)
    for (SparseRows::InnerIterator it(M, r); it; ++it) entries.emplace_back(r, it.col(), it.value());
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (SparseRows::InnerIterator it(G_, rows_[k]); it; ++it) {
      entries.emplace_back(n + static_cast<Index>(k), it.col(), it.value());
      entries.emplace_back(it.col(), n + static_cast<Index>(k), it.value());
    }
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (SparseRows::InnerIterator it(G_, rows_[k]); it; ++it) {
      const Index row = n + static_cast<Index>(k);
      places_.push_back({&it.value() - G_.valuePtr(), &matrix_.coeffRef(row, it.col()) - matrix_.valuePtr(),
                         &matrix_.coeffRef(it.col(), row) - matrix_.valuePtr()});
    }
}

void KluAccelerations::factorise() {
  int* const outer = matrix_.outerIndexPtr();
  int* const inner = matrix_.innerIndexPtr();
  if (!pivoting_) {
    klu_refactor(outer, inner, matrix_.valuePtr(), symbolic_, numeric_, &common_);
    return;
  }
  klu_free_numeric(&numeric_, &common_);
  numeric_ = klu_factor(outer, inner, matrix_.valuePtr(), symbolic_, &common_);
}

void KluAccelerations::accelerate(double t, const VectorXd& z, const VectorXd& w, VectorXd& acceleration) {
  const Index n = system_.solved_coordinates();
  system_.expand(z, q_);
  system_.expand_rate(w, v_);
  system_.jacobian(q_, G_, scratch_);
  for (const auto& [from, below, above] : places_)
    matrix_.valuePtr()[below] = matrix_.valuePtr()[above] = G_.valuePtr()[from];
  f_.setZero();
  system_.add_applied_force(t, q_, v_, 1.0, f_);
  system_.reduce_force(f_, force_);
  system_.constraint_bias(t, q_, v_, bias_);
  b_.head(n) = force_;
  for (std::size_t k = 0; k < rows_.size(); ++k) b_[n + static_cast<Index>(k)] = -bias_[rows_[k]];
  factorise();
  if (!numeric_) {  // singular
    acceleration.setConstant(n, std::nan(""));
    return;
  }
  klu_solve(symbolic_, numeric_, static_cast<int>(b_.size()), 1, b_.data(), &common_);
  acceleration = b_.head(n);
}

}  // namespace unfurl::bench
