// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/reduced_sum.hpp"

#include <algorithm>

namespace unfurl {
namespace {

SparseRows square_of(const ForceDerivative& entries, Index size) {
  SparseRows A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

int place_of(const SparseRows& A, int row, int column) {
  const int* const begin = A.innerIndexPtr() + A.outerIndexPtr()[row];
  const int* const end = A.innerIndexPtr() + A.outerIndexPtr()[row + 1];
  return static_cast<int>(std::lower_bound(begin, end, column) - A.innerIndexPtr());
}

}  // namespace

ForceDerivative& ReducedSum::begin(const SparseRows& B) {
  B_ = &B;
  summed_ = false;
  entries_.clear();
  entries_.keeps_places = true;
  return entries_;
}

bool ReducedSum::same_places() const {
  if (entries_.size() != row_.size()) return false;
  for (std::size_t e = 0; e < entries_.size(); ++e)
    if (entries_[e].row() != row_[e] || entries_[e].col() != column_[e]) return false;
  return true;
}

void ReducedSum::find_places() {
  const SparseRows& B = *B_;
  A_ = square_of(entries_, B.rows());
  for (auto* list : {&row_, &column_, &to_, &target_}) list->clear();
  for (const auto& entry : entries_) {
    row_.push_back(entry.row());
    column_.push_back(entry.col());
    to_.push_back(place_of(A_, entry.row(), entry.col()));
  }
  const int* const first = B.outerIndexPtr();
  const auto length = [first](Index i) { return static_cast<std::size_t>(first[i + 1] - first[i]); };
  std::size_t count = 0;
  for (int i = 0; i < A_.outerSize(); ++i)
    for (SparseRows::InnerIterator a(A_, i); a; ++a) count += length(i) * length(a.col());
  by_product_ = count > 16 * static_cast<std::size_t>(A_.nonZeros());
  if (by_product_) return;
  ForceDerivative reduced;
  start_.assign(1, 0);
  weight_.clear();
  for (int i = 0; i < A_.outerSize(); ++i)
    for (SparseRows::InnerIterator a(A_, i); a; ++a) {
      for (SparseRows::InnerIterator k(B, i); k; ++k)
        for (SparseRows::InnerIterator l(B, a.col()); l; ++l) {
          reduced.emplace_back(static_cast<int>(k.col()), static_cast<int>(l.col()), 0.0);
          weight_.push_back(k.value() * l.value());
        }
      start_.push_back(static_cast<int>(reduced.size()));
    }
  result_ = square_of(reduced, B.cols());
  for (const auto& entry : reduced) target_.push_back(place_of(result_, entry.row(), entry.col()));
}

const SparseRows& ReducedSum::sum() {
  if (summed_) return result_;
  summed_ = true;
  if (A_.rows() != B_->rows() || !same_places()) find_places();
  double* const a = A_.valuePtr();
  std::fill_n(a, A_.nonZeros(), 0.0);
  for (std::size_t e = 0; e < entries_.size(); ++e) a[to_[e]] += entries_[e].value();
  if (by_product_) {
    result_ = B_->transpose() * SparseRows(A_ * *B_);
    return result_;
  }
  double* const sums = result_.valuePtr();
  std::fill_n(sums, result_.nonZeros(), 0.0);
  for (std::size_t i = 0; i + 1 < start_.size(); ++i)
    for (auto p = static_cast<std::size_t>(start_[i]), end = static_cast<std::size_t>(start_[i + 1]); p < end;
         ++p)
      sums[target_[p]] += weight_[p] * a[i];
  return result_;
}

}  // namespace unfurl
