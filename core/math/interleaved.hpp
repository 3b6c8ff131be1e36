// SPDX-License-Identifier: BSD-3-Clause
// Several vectors of one kind at once, held entry by entry: entry i of vector c is x[i * columns + c]. The
// stages of a step are kept like that: what is done to all of them costs one pass over indices.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/math/types.hpp"

namespace unfurl {

using Interleaved = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
inline constexpr int most_columns = 8;

// How many columns, and whether they go through AVX2.
struct LaneCount {
  int count;
  bool wide = false;
  constexpr LaneCount(int columns, bool widely = false) : count(columns), wide(widely) {}
  constexpr operator int() const { return count; }
};

// work(std::integral_constant<LaneCount, columns>()), 1 <= columns <= most_columns: the compiler knows their
// number.
template <bool wide = false, class Work>
inline void with_columns(int columns, Work&& work) {
  switch (columns) {
    case 1:
      return work(std::integral_constant<LaneCount, LaneCount(1, wide)>());
    case 2:
      return work(std::integral_constant<LaneCount, LaneCount(2, wide)>());
    case 3:
      return work(std::integral_constant<LaneCount, LaneCount(3, wide)>());
    case 4:
      return work(std::integral_constant<LaneCount, LaneCount(4, wide)>());
    case 5:
      return work(std::integral_constant<LaneCount, LaneCount(5, wide)>());
    case 6:
      return work(std::integral_constant<LaneCount, LaneCount(6, wide)>());
    case 7:
      return work(std::integral_constant<LaneCount, LaneCount(7, wide)>());
    default:
      eigen_assert(columns == most_columns);
      return work(std::integral_constant<LaneCount, LaneCount(most_columns, wide)>());
  }
}

// work(std::bool_constant<wide>()), wide where the processor has AVX2. Everything that it then calls and that
// the compiler can see is compiled for that, so that it should be one kernel; its captures, by value, are
// known to be nobody else's. Neither instruction set fuses products with sums: results have the same bits.
#if defined(__x86_64__)
template <class Work>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] void work_widely(Work work) {
  work(std::true_type());
}
template <class Work>
inline void with_widest(Work work) {
  static const bool wide = __builtin_cpu_supports("avx2");
  if (wide)
    work_widely(work);
  else
    work(std::false_type());
}
#else
template <class Work>
inline void with_widest(Work work) {
  work(std::false_type());
}
#endif

// with_columns for one kernel, as with_widest does it.
template <class Work>
inline void with_wide_columns(int columns, Work work) {
  with_widest([columns, work](auto wide) { with_columns<wide()>(columns, work); });
}

// One entry of K vectors, in packs of the width that every 64-bit processor computes with, or of AVX2's.
template <LaneCount K>
struct Lanes {
  static constexpr int width = K.wide ? 4 : 2, packs = K / width;
  static constexpr bool has_pair = K - packs * width >= 2, has_last = K % 2 == 1;
  typedef double Pack __attribute__((vector_size(width * sizeof(double))));
  typedef double Pair __attribute__((vector_size(16)));
  Pack pack[packs > 0 ? packs : 1];
  Pair pair;    // what packs of four leave
  double last;  // for odd K

  Lanes() = default;
  explicit Lanes(const double* x) {
    for (int i = 0; i < packs; ++i) std::memcpy(&pack[i], x + width * i, sizeof(Pack));
    if constexpr (has_pair) std::memcpy(&pair, x + width * packs, sizeof(Pair));
    if constexpr (has_last) last = x[K - 1];
  }
  static Lanes all(double value) {
    Lanes out;
    for (int i = 0; i < packs; ++i) out.pack[i] = value - Pack{};
    if constexpr (has_pair) out.pair = Pair{value, value};
    if constexpr (has_last) out.last = value;
    return out;
  }
  void store(double* x) const {
    for (int i = 0; i < packs; ++i) std::memcpy(x + width * i, &pack[i], sizeof(Pack));
    if constexpr (has_pair) std::memcpy(x + width * packs, &pair, sizeof(Pair));
    if constexpr (has_last) x[K - 1] = last;
  }

  template <class Operation>  // (out, a, b), on packs, pairs and numbers alike
  static Lanes map(const Lanes& a, const Lanes& b, Operation operation) {
    Lanes out;
    for (int i = 0; i < packs; ++i) operation(out.pack[i], a.pack[i], b.pack[i]);
    if constexpr (has_pair) operation(out.pair, a.pair, b.pair);
    if constexpr (has_last) operation(out.last, a.last, b.last);
    return out;
  }
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto& out, const auto& x, const auto& y) { out = x + y; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto& out, const auto& x, const auto& y) { out = x - y; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto& out, const auto& x, const auto& y) { out = x * y; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto& out, const auto& x, const auto& y) { out = x / y; });
  }
  friend Lanes operator*(double a, const Lanes& b) { return all(a) * b; }
  // The larger magnitude; what is not a number is passed over.
  friend Lanes larger(const Lanes& most, const Lanes& x) {
    return map(most, x, [](auto& out, const auto& m, const auto& y) {
      const auto up = y > m ? y : m, down = -y;
      out = down > up ? down : up;
    });
  }
  double largest() const {
    double most = 0;
    each([&most](double x) { most = x > most ? x : most; });
    return most;
  }
  double sum() const {
    double total = 0;
    each([&total](double x) { total += x; });
    return total;
  }
  template <class Take>
  void each(Take take) const {
    for (int i = 0; i < packs; ++i)
      for (int k = 0; k < width; ++k) take(pack[i][k]);
    if constexpr (has_pair) take(pair[0]), take(pair[1]);
    if constexpr (has_last) take(last);
  }
};

// Row r of A times x.
template <LaneCount K>
inline Lanes<K> row_times(const SparseRows& A, Index r, const double* x) {
  const int* const column = A.innerIndexPtr();
  const double* const value = A.valuePtr();
  Lanes<K> sum = Lanes<K>::all(0.0);
  for (int p = A.outerIndexPtr()[r], end = A.outerIndexPtr()[r + 1]; p < end; ++p)
    sum = sum + value[p] * Lanes<K>(x + static_cast<Index>(column[p]) * K);
  return sum;
}

// y = A x.
template <LaneCount K>
inline void multiply(const SparseRows& A, const double* x, double* y) {
  for (Index r = 0, rows = A.rows(); r < rows; ++r) row_times<K>(A, r, x).store(y + r * K);
}

// row + sum_j T_cj x_j for a matrix T [K x K] held column by column.
template <LaneCount K>
inline Lanes<K> mixed(const Lanes<K>& row, const double* x, const double* T) {
  Lanes<K> sum = row;
  for (int j = 0; j < K; ++j) sum = sum + x[j] * Lanes<K>(T + j * K);
  return sum;
}

// y = x T^T.
template <LaneCount K>
inline void mix(const double* x, Index rows, const double* T, double* y) {
  for (Index r = 0; r < rows; ++r) mixed<K>(Lanes<K>::all(0.0), x + r * K, T).store(y + r * K);
}

// The largest magnitude of `size` numbers; what is not a number is passed over.
inline double largest_magnitude(const double* x, Index size) {
  double most = 0;
  with_widest([x, size, out = &most](auto wide) {
    using Four = Lanes<LaneCount(4, wide())>;
    Four fours = Four::all(0.0);
    Index i = 0;
    for (; i + 4 <= size; i += 4) fours = larger(fours, Four(x + i));
    double found = fours.largest();
    for (; i < size; ++i) found = std::abs(x[i]) > found ? std::abs(x[i]) : found;
    *out = found;
  });
  return most;
}

// Every one of `size` numbers is finite.
inline bool all_finite(const double* x, Index size) {
  Lanes<4> rest = Lanes<4>::all(0.0);  // not zero once an entry is not finite
  Index i = 0;
  for (; i + 4 <= size; i += 4) rest = rest + 0.0 * Lanes<4>(x + i);
  double out = rest.sum();
  for (; i < size; ++i) out += 0.0 * x[i];
  return out == 0.0;
}

}  // namespace unfurl
