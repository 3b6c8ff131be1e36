// SPDX-License-Identifier: BSD-3-Clause
#include "core/math/twofold_ldlt.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <type_traits>

namespace unfurl {
namespace {

// work(std::bool_constant<fused>()): products fused, and four numbers at once, where the processor can
// (core/math/twofold.hpp).
#if defined(__x86_64__)
template <class Work>
[[gnu::target("avx2,fma"), gnu::flatten, gnu::noinline]] void work_fused(Work work) {
  work(std::true_type());
}
template <class Work>
void with_fused(Work work) {
  static const bool fused = __builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2");
  if (fused)
    work_fused(work);
  else
    work(std::false_type());
}
#else
template <class Work>
void with_fused(Work work) {
  work(std::false_type());
}
#endif

template <bool fused>
Twofold times(const Twofold& a, const Twofold& x) {
  return Twofold::times<fused>(a, x);
}
template <bool fused>
TwofoldPair times(const TwofoldPair& a, const TwofoldPair& x) {
  return TwofoldPair::times<fused>(a, x);
}
template <bool fused>
TwofoldPair times(const Twofold& a, const TwofoldPair& x) {
  return times<fused>(both(a, a), x);
}

// Four numbers at once, to the same bits: numbers 0, 2, 1, 3 of those at these places.
using TwofoldFour = TwofoldOf<DoubleFour>;
template <class Places>
inline TwofoldFour four_of(const Twofold* x, Places place) {
  DoublePair number[4];
  for (int k = 0; k < 4; ++k) std::memcpy(&number[k], &x[place(k)], sizeof(DoublePair));
  const DoubleFour a = __builtin_shufflevector(number[0], number[1], 0, 1, 2, 3),
                   b = __builtin_shufflevector(number[2], number[3], 0, 1, 2, 3);
  TwofoldFour out;
  out.hi = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  out.lo = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  return out;
}
template <class Places>
inline void store_four(const TwofoldFour& four, Twofold* x, Places place) {
  const DoubleFour a = __builtin_shufflevector(four.hi, four.lo, 0, 4, 2, 6),
                   b = __builtin_shufflevector(four.hi, four.lo, 1, 5, 3, 7);
  const DoublePair number[4] = {__builtin_shufflevector(a, a, 0, 1), __builtin_shufflevector(a, a, 2, 3),
                                __builtin_shufflevector(b, b, 0, 1), __builtin_shufflevector(b, b, 2, 3)};
  for (int k = 0; k < 4; ++k) std::memcpy(static_cast<void*>(x + place(k)), &number[k], sizeof(DoublePair));
}

// b[rows[p]] -= l[p] y for p of [first, last), whose rows differ.
template <bool fused>
void subtract_column(const Twofold* l, const int* rows, std::size_t first, std::size_t last, const Twofold& y,
                     Twofold* b) {
  std::size_t p = first;
  if constexpr (fused) {
    const TwofoldFour four_times = four_of(&y, [](int) { return 0; });
    for (; p + 4 <= last; p += 4) {
      const auto row = [to = rows + p](int k) { return to[k]; };
      store_four(four_of(b, row) - TwofoldFour::times<fused>(four_of(l + p, std::identity()), four_times), b,
                 row);
    }
  }
  const TwofoldPair twice = both(y, y);
  for (; p + 2 <= last; p += 2) {
    Twofold &u = b[rows[p]], &v = b[rows[p + 1]];
    const TwofoldPair left = both(u, v) - times<fused>(both(l[p], l[p + 1]), twice);
    u = one_of(left, 0);
    v = one_of(left, 1);
  }
  if (p < last) b[rows[p]] = b[rows[p]] - times<fused>(l[p], y);
}

// sum - l[p] b[rows[p]] - ..., every second product by itself: one sum has to wait for the other.
template <bool fused>
Twofold subtract_row(const Twofold& sum, const Twofold* l, const int* rows, std::size_t first,
                     std::size_t last, const Twofold* b) {
  TwofoldPair products;
  std::size_t p = first;
  for (; p + 2 <= last; p += 2)
    products = products + times<fused>(both(l[p], l[p + 1]), both(b[rows[p]], b[rows[p + 1]]));
  Twofold even = one_of(products, 0);
  if (p < last) even = even + times<fused>(l[p], b[rows[p]]);
  return sum - (even + one_of(products, 1));
}

// Of two right-hand sides each entry is a pair already.
template <bool fused>
void subtract_column(const Twofold* l, const int* rows, std::size_t first, std::size_t last,
                     const TwofoldPair& y, TwofoldPair* b) {
  for (std::size_t p = first; p < last; ++p) b[rows[p]] = b[rows[p]] - times<fused>(l[p], y);
}
template <bool fused>
TwofoldPair subtract_row(const TwofoldPair& sum, const Twofold* l, const int* rows, std::size_t first,
                         std::size_t last, const TwofoldPair* b) {
  TwofoldPair even, odd;
  std::size_t p = first;
  for (; p + 2 <= last; p += 2) {
    even = even + times<fused>(l[p], b[rows[p]]);
    odd = odd + times<fused>(l[p + 1], b[rows[p + 1]]);
  }
  if (p < last) even = even + times<fused>(l[p], b[rows[p]]);
  return sum - (even + odd);
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
  bool held = false;
  with_fused([this, values, diagonal_shift, &held](auto fused) {
    held = eliminate<fused()>(values, diagonal_shift);
  });
  return held;
}

template <bool fused>
bool TwofoldLdlt::eliminate(const double* values, const double* diagonal_shift) {
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
      subtract_column<fused>(l_.data(), a.row_index_.data(), static_cast<std::size_t>(a.column_start_[i]),
                             end, yi, work_.data());
      const Twofold lki = times<fused>(yi, inverse_pivot_[i]);
      d = d - times<fused>(lki, yi);
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
  with_fused([this, b](auto fused) {
    const std::size_t n = pivot_.size();
    const int* const start = pattern_.column_start_.data();
    const int* const rows = pattern_.row_index_.data();
    const auto at = [start](std::size_t j) { return static_cast<std::size_t>(start[j]); };
    for (std::size_t j = 0; j < n; ++j) subtract_column<fused()>(l_.data(), rows, at(j), at(j + 1), b[j], b);
    for (std::size_t j = n; j-- > 0;)
      b[j] = subtract_row<fused()>(times<fused()>(inverse_pivot_[j], b[j]), l_.data(), rows, at(j), at(j + 1),
                                   b);
  });
}

void TwofoldLdlt::solve_ordered(Twofold* b) const {
  solve_in_place(b);
}
void TwofoldLdlt::solve_ordered(TwofoldPair* b) const {
  solve_in_place(b);
}

void TwofoldLdlt::subtract_product(const double* values, const TwofoldPair* x, TwofoldPair* r) const {
  const SparseLdlt& a = pattern_;
  with_fused([&a, values, x, r](auto fused) {
    for (std::size_t k = 0, n = static_cast<std::size_t>(a.n_); k < n; ++k)
      for (auto e = static_cast<std::size_t>(a.entry_start_[k]);
           e < static_cast<std::size_t>(a.entry_start_[k + 1]); ++e) {
        const Twofold value = values[a.entry_source_[e]];
        const auto row = static_cast<std::size_t>(a.entry_row_[e]);
        r[k] = r[k] - times<fused()>(value, x[row]);
        if (row != k) r[row] = r[row] - times<fused()>(value, x[k]);
      }
  });
}

void TwofoldLdlt::subtract_product(const double* values, const Twofold* x, Twofold* r) const {
  const SparseLdlt& a = pattern_;
  with_fused([&a, values, x, r](auto fused) {
    for (std::size_t k = 0, n = static_cast<std::size_t>(a.n_); k < n; ++k)
      for (auto e = static_cast<std::size_t>(a.entry_start_[k]);
           e < static_cast<std::size_t>(a.entry_start_[k + 1]); ++e) {
        const Twofold value = values[a.entry_source_[e]];
        const auto row = static_cast<std::size_t>(a.entry_row_[e]);
        if (row == k) {
          r[k] = r[k] - times<fused()>(value, x[k]);
          continue;
        }
        const TwofoldPair left = both(r[k], r[row]) - times<fused()>(both(value, value), both(x[row], x[k]));
        r[k] = one_of(left, 0);
        r[row] = one_of(left, 1);
      }
  });
}

}  // namespace unfurl
