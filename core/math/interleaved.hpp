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

// work(std::integral_constant<int, columns>()), 1 <= columns <= most_columns: the compiler knows their
// number.
template <class Work>
inline void with_columns(int columns, Work&& work) {
  switch (columns) {
    case 1:
      return work(std::integral_constant<int, 1>());
    case 2:
      return work(std::integral_constant<int, 2>());
    case 3:
      return work(std::integral_constant<int, 3>());
    case 4:
      return work(std::integral_constant<int, 4>());
    case 5:
      return work(std::integral_constant<int, 5>());
    case 6:
      return work(std::integral_constant<int, 6>());
    case 7:
      return work(std::integral_constant<int, 7>());
    default:
      eigen_assert(columns == most_columns);
      return work(std::integral_constant<int, most_columns>());
  }
}

// One entry of K vectors, in pairs of the width that every 64-bit processor computes with.
template <int K>
struct Lanes {
  typedef double Pair __attribute__((vector_size(16)));
  static constexpr int pairs = K / 2;
  Pair pair[pairs > 0 ? pairs : 1];
  double last;  // for odd K

  Lanes() = default;
  explicit Lanes(const double* x) {
    for (int i = 0; i < pairs; ++i) std::memcpy(&pair[i], x + 2 * i, sizeof(Pair));
    if constexpr (K % 2 == 1) last = x[K - 1];
  }
  static Lanes all(double value) {
    Lanes out;
    for (int i = 0; i < pairs; ++i) out.pair[i] = Pair{value, value};
    if constexpr (K % 2 == 1) out.last = value;
    return out;
  }
  void store(double* x) const {
    for (int i = 0; i < pairs; ++i) std::memcpy(x + 2 * i, &pair[i], sizeof(Pair));
    if constexpr (K % 2 == 1) x[K - 1] = last;
  }

  template <class Operation>  // on pairs and on numbers alike
  static Lanes map(const Lanes& a, const Lanes& b, Operation operation) {
    Lanes out;
    for (int i = 0; i < pairs; ++i) out.pair[i] = operation(a.pair[i], b.pair[i]);
    if constexpr (K % 2 == 1) out.last = operation(a.last, b.last);
    return out;
  }
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto x, auto y) { return x + y; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto x, auto y) { return x - y; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto x, auto y) { return x * y; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return map(a, b, [](auto x, auto y) { return x / y; });
  }
  friend Lanes operator*(double a, const Lanes& b) { return all(a) * b; }
  // The larger magnitude; what is not a number is passed over.
  friend Lanes larger(const Lanes& most, const Lanes& x) {
    return map(most, x, [](auto m, auto y) {
      const auto up = y > m ? y : m, down = -y;
      return down > up ? down : up;
    });
  }
  double largest() const {
    double most = 0;
    for (int i = 0; i < pairs; ++i)
      for (int k = 0; k < 2; ++k) most = pair[i][k] > most ? pair[i][k] : most;
    if constexpr (K % 2 == 1) most = last > most ? last : most;
    return most;
  }
  double sum() const {
    double total = 0;
    for (int i = 0; i < pairs; ++i) total += pair[i][0] + pair[i][1];
    if constexpr (K % 2 == 1) total += last;
    return total;
  }
};

// Row r of A times x.
template <int K>
inline Lanes<K> row_times(const SparseRows& A, Index r, const double* x) {
  const int* const column = A.innerIndexPtr();
  const double* const value = A.valuePtr();
  Lanes<K> sum = Lanes<K>::all(0.0);
  for (int p = A.outerIndexPtr()[r], end = A.outerIndexPtr()[r + 1]; p < end; ++p)
    sum = sum + value[p] * Lanes<K>(x + static_cast<Index>(column[p]) * K);
  return sum;
}

// y = A x.
template <int K>
inline void multiply(const SparseRows& A, const double* x, double* y) {
  for (Index r = 0, rows = A.rows(); r < rows; ++r) row_times<K>(A, r, x).store(y + r * K);
}

// row + sum_j T_cj x_j for a matrix T [K x K] held column by column.
template <int K>
inline Lanes<K> mixed(Lanes<K> row, const double* x, const double* T) {
  for (int j = 0; j < K; ++j) row = row + x[j] * Lanes<K>(T + j * K);
  return row;
}

// y = x T^T.
template <int K>
inline void mix(const double* x, Index rows, const double* T, double* y) {
  for (Index r = 0; r < rows; ++r) mixed<K>(Lanes<K>::all(0.0), x + r * K, T).store(y + r * K);
}

// The largest magnitude of `size` numbers; what is not a number is passed over.
inline double largest_magnitude(const double* x, Index size) {
  Lanes<4> most = Lanes<4>::all(0.0);
  Index i = 0;
  for (; i + 4 <= size; i += 4) most = larger(most, Lanes<4>(x + i));
  double out = most.largest();
  for (; i < size; ++i) out = std::abs(x[i]) > out ? std::abs(x[i]) : out;
  return out;
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
