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

// How many columns, and how many of them go through one instruction: 2 on every 64-bit processor, 4 by AVX2,
// 8 by AVX-512.
struct LaneCount {
  int count;
  int width = 2;
  constexpr LaneCount(int columns, int wide = 2) : count(columns), width(wide) {}
  constexpr operator int() const { return count; }
};
template <int columns, int width>
using LaneConstant = std::integral_constant<LaneCount, LaneCount(columns, width)>;

// work(LaneConstant<columns, width>()), 1 <= columns <= most_columns: the compiler knows their number.
template <int width = 2, class Work>
inline void with_columns(int columns, Work&& work) {
  switch (columns) {
    case 1:
      return work(LaneConstant<1, width>());
    case 2:
      return work(LaneConstant<2, width>());
    case 3:
      return work(LaneConstant<3, width>());
    case 4:
      return work(LaneConstant<4, width>());
    case 5:
      return work(LaneConstant<5, width>());
    case 6:
      return work(LaneConstant<6, width>());
    case 7:
      return work(LaneConstant<7, width>());
    default:
      eigen_assert(columns == most_columns);
      return work(LaneConstant<most_columns, width>());
  }
}

// work(std::integral_constant<int, width>()) with the widest instructions of the processor, eight numbers
// only where `eight` says so. Everything that it then calls and that the compiler can see is compiled for
// them, so that it should be one kernel; its captures, by value, are known to be nobody else's. No
// instruction set fuses products with sums: results have the same bits.
#if defined(__x86_64__)
template <class Work>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] void work_by_four(Work work) {
  work(std::integral_constant<int, 4>());
}
template <class Work>
[[gnu::target("avx512f"), gnu::flatten, gnu::noinline]] void work_by_eight(Work work) {
  work(std::integral_constant<int, 8>());
}
template <bool eight = false, class Work>
inline void with_widest(Work work) {
  static const int width = __builtin_cpu_supports("avx512f") ? 8 : __builtin_cpu_supports("avx2") ? 4 : 2;
  if constexpr (eight)
    if (width == 8) return work_by_eight(work);
  if (width >= 4)
    work_by_four(work);
  else
    work(std::integral_constant<int, 2>());
}
#else
template <bool eight = false, class Work>
inline void with_widest(Work work) {
  work(std::integral_constant<int, 2>());
}
#endif

// The same for one kernel of so many columns, work(LaneConstant<columns, width>()).
template <int columns, class Work>
inline void with_wide(Work work) {
  with_widest<columns == most_columns>([work](auto width) { work(LaneConstant<columns, width()>()); });
}
template <class Work>
inline void with_wide_columns(int columns, Work work) {
  if (columns == most_columns) return with_wide<most_columns>(work);
  with_widest([columns, work](auto width) { with_columns<width()>(columns, work); });
}

// All entries of a pack. Compiled for its width by itself, or filling it becomes an instruction a number.
template <class Pack>
inline void fill(Pack& pack, double value) {
  pack = value - Pack{};
}
#if defined(__x86_64__)
typedef double FourNumbers __attribute__((vector_size(32)));
typedef double EightNumbers __attribute__((vector_size(64)));
[[gnu::target("avx2")]] inline void fill(FourNumbers& pack, double value) {
  pack = value - FourNumbers{};
}
[[gnu::target("avx512f")]] inline void fill(EightNumbers& pack, double value) {
  pack = value - EightNumbers{};
}
#endif

// One entry of K vectors, in packs of as many as go through one instruction.
template <LaneCount K>
struct Lanes {
  static constexpr int width = K.width, packs = K / width;
  static_assert(width < 8 || K % width == 0);
  static constexpr bool has_pair = K - packs * width >= 2, has_last = K % 2 == 1;
  typedef double Pack __attribute__((vector_size(width * sizeof(double))));
  typedef double Pair __attribute__((vector_size(16)));
  Pack pack[packs > 0 ? packs : 1];
  Pair pair;    // what packs leave
  double last;  // for odd K

  Lanes() = default;
  explicit Lanes(const double* x) {
    for (int i = 0; i < packs; ++i) std::memcpy(&pack[i], x + width * i, sizeof(Pack));
    if constexpr (has_pair) std::memcpy(&pair, x + width * packs, sizeof(Pair));
    if constexpr (has_last) last = x[K - 1];
  }
  static Lanes all(double value) {
    Lanes out;
    for (int i = 0; i < packs; ++i) fill(out.pack[i], value);
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
  // Zero where the magnitude is no larger than `bound`, or not a number.
  friend Lanes beyond(const Lanes& x, double bound) {
    return map(x, all(bound), [](auto& out, const auto& y, const auto& b) {
      const std::remove_cvref_t<decltype(y)> none{}, down = -y;
      out = y > b ? y : down > b ? y : none;
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
  with_wide<8>([x, size, out = &most](auto eight) {
    using Eight = Lanes<eight()>;
    Eight eights = Eight::all(0.0);
    Index i = 0;
    for (; i + 8 <= size; i += 8) eights = larger(eights, Eight(x + i));
    double found = eights.largest();
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
