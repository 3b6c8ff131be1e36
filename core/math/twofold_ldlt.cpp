// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/twofold_ldlt.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

TwofoldLdlt::TwofoldLdlt(const SparseLdlt& pattern)
    : pattern_(pattern),
      l_(pattern.row_index_.size()),
      pivot_(static_cast<std::size_t>(pattern.n_)),
      inverse_pivot_(pivot_.size()),
      work_(pivot_.size()),
      fill_(pivot_.size()) {}

bool TwofoldLdlt::factorise(const double* values, const double* diagonal_shift) {
  const SparseLdlt& a = pattern_;
  std::copy(a.column_start_.begin(), a.column_start_.end() - 1, fill_.begin());
  std::fill(work_.begin(), work_.end(), Twofold());
  for (std::size_t k = 0; k < pivot_.size(); ++k) {
    for (auto e = static_cast<std::size_t>(a.entry_start_[k]);
         e < static_cast<std::size_t>(a.entry_start_[k + 1]); ++e) {
      Twofold& y = work_[static_cast<std::size_t>(a.entry_row_[e])];
      y = y + Twofold(values[a.entry_source_[e]]);
    }
    Twofold d = work_[k] + Twofold(diagonal_shift[k]);
    work_[k] = 0.0;
    for (auto r = static_cast<std::size_t>(a.reach_start_[k]);
         r < static_cast<std::size_t>(a.reach_start_[k + 1]); ++r) {
      const auto i = static_cast<std::size_t>(a.reach_[r]);
      const Twofold yi = work_[i];
      work_[i] = 0.0;
      const auto end = static_cast<std::size_t>(fill_[i]);
      for (auto p = static_cast<std::size_t>(a.column_start_[i]); p < end; ++p) {
        Twofold& y = work_[static_cast<std::size_t>(a.row_index_[p])];
        y = y - l_[p] * yi;
      }
      const Twofold lki = yi * inverse_pivot_[i];
      d = d - lki * yi;
      l_[end] = lki;
      ++fill_[i];
    }
    if (d.hi == 0.0 || !std::isfinite(d.hi)) return false;
    pivot_[k] = d;
    inverse_pivot_[k] = inverse(d);
  }
  return true;
}

void TwofoldLdlt::solve_ordered(Twofold* b) const {
  const SparseLdlt& a = pattern_;
  const std::size_t n = pivot_.size();
  const auto start = [&](std::size_t j) { return static_cast<std::size_t>(a.column_start_[j]); };
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t p = start(j); p < start(j + 1); ++p)
      b[a.row_index_[p]] = b[a.row_index_[p]] - l_[p] * b[j];
  for (std::size_t j = n; j-- > 0;) {
    Twofold sum = inverse_pivot_[j] * b[j];
    for (std::size_t p = start(j); p < start(j + 1); ++p) sum = sum - l_[p] * b[a.row_index_[p]];
    b[j] = sum;
  }
}

void TwofoldLdlt::subtract_product(const double* values, const Twofold* x, Twofold* r) const {
  const SparseLdlt& a = pattern_;
  for (std::size_t k = 0; k < pivot_.size(); ++k)
    for (auto e = static_cast<std::size_t>(a.entry_start_[k]);
         e < static_cast<std::size_t>(a.entry_start_[k + 1]); ++e) {
      const Twofold value = values[a.entry_source_[e]];
      const auto row = static_cast<std::size_t>(a.entry_row_[e]);
      r[k] = r[k] - value * x[row];
      if (row != k) r[row] = r[row] - value * x[k];
    }
}

}  // namespace unfurl
