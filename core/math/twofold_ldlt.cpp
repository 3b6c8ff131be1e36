// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/twofold_ldlt.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

// b[rows[p]] -= l[p] y for p of [first, last), whose rows differ.
void subtract_column(const Twofold* l, const int* rows, std::size_t first, std::size_t last, const Twofold& y,
                     Twofold* b) {
  const TwofoldPair twice = both(y, y);
  std::size_t p = first;
  for (; p + 2 <= last; p += 2) {
    Twofold &u = b[rows[p]], &v = b[rows[p + 1]];
    const TwofoldPair left = both(u, v) - both(l[p], l[p + 1]) * twice;
    u = one_of(left, 0);
    v = one_of(left, 1);
  }
  if (p < last) b[rows[p]] = b[rows[p]] - l[p] * y;
}

// sum - l[p] b[rows[p]] - ..., in the order of p.
Twofold subtract_row(Twofold sum, const Twofold* l, const int* rows, std::size_t first, std::size_t last,
                     const Twofold* b) {
  std::size_t p = first;
  for (; p + 2 <= last; p += 2) {
    const TwofoldPair product = both(l[p], l[p + 1]) * both(b[rows[p]], b[rows[p + 1]]);
    sum = sum - one_of(product, 0);
    sum = sum - one_of(product, 1);
  }
  return p < last ? sum - l[p] * b[rows[p]] : sum;
}

// Of two right-hand sides each entry is a pair already.
void subtract_column(const Twofold* l, const int* rows, std::size_t first, std::size_t last,
                     const TwofoldPair& y, TwofoldPair* b) {
  for (std::size_t p = first; p < last; ++p) b[rows[p]] = b[rows[p]] - both(l[p], l[p]) * y;
}
TwofoldPair subtract_row(TwofoldPair sum, const Twofold* l, const int* rows, std::size_t first,
                         std::size_t last, const TwofoldPair* b) {
  for (std::size_t p = first; p < last; ++p) sum = sum - both(l[p], l[p]) * b[rows[p]];
  return sum;
}
Twofold times(const Twofold& a, const Twofold& x) {
  return a * x;
}
TwofoldPair times(const Twofold& a, const TwofoldPair& x) {
  return both(a, a) * x;
}

}  // namespace

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
      subtract_column(l_.data(), a.row_index_.data(), static_cast<std::size_t>(a.column_start_[i]), end, yi,
                      work_.data());
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

template <class Number>
void TwofoldLdlt::solve_in_place(Number* b) const {
  const SparseLdlt& a = pattern_;
  const std::size_t n = pivot_.size();
  const auto start = [&](std::size_t j) { return static_cast<std::size_t>(a.column_start_[j]); };
  const int* const rows = a.row_index_.data();
  for (std::size_t j = 0; j < n; ++j) subtract_column(l_.data(), rows, start(j), start(j + 1), b[j], b);
  for (std::size_t j = n; j-- > 0;)
    b[j] = subtract_row(times(inverse_pivot_[j], b[j]), l_.data(), rows, start(j), start(j + 1), b);
}

void TwofoldLdlt::solve_ordered(Twofold* b) const {
  solve_in_place(b);
}
void TwofoldLdlt::solve_ordered(TwofoldPair* b) const {
  solve_in_place(b);
}

void TwofoldLdlt::subtract_product(const double* values, const TwofoldPair* x, TwofoldPair* r) const {
  const SparseLdlt& a = pattern_;
  for (std::size_t k = 0; k < pivot_.size(); ++k)
    for (auto e = static_cast<std::size_t>(a.entry_start_[k]);
         e < static_cast<std::size_t>(a.entry_start_[k + 1]); ++e) {
      const double number = values[a.entry_source_[e]];
      const TwofoldPair value(DoublePair{number, number});
      const auto row = static_cast<std::size_t>(a.entry_row_[e]);
      r[k] = r[k] - value * x[row];
      if (row != k) r[row] = r[row] - value * x[k];
    }
}

void TwofoldLdlt::subtract_product(const double* values, const Twofold* x, Twofold* r) const {
  const SparseLdlt& a = pattern_;
  for (std::size_t k = 0; k < pivot_.size(); ++k)
    for (auto e = static_cast<std::size_t>(a.entry_start_[k]);
         e < static_cast<std::size_t>(a.entry_start_[k + 1]); ++e) {
      const Twofold value = values[a.entry_source_[e]];
      const auto row = static_cast<std::size_t>(a.entry_row_[e]);
      if (row == k) {
        r[k] = r[k] - value * x[k];
        continue;
      }
      const TwofoldPair left = both(r[k], r[row]) - both(value, value) * both(x[row], x[k]);
      r[k] = one_of(left, 0);
      r[row] = one_of(left, 1);
    }
}

}  // namespace unfurl
