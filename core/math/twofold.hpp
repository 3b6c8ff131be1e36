// SPDX-License-Identifier: BSD-3-Clause
// Numbers of twice the digits: an unevaluated sum of two doubles, hi + lo with |lo| <= ulp(hi) / 2, relative
// precision 2^-104 (Dekker 1971, Numer. Math. 18; Knuth, The Art of Computer Programming 2, 4.2.2). Right
// only where the compiler keeps to IEEE arithmetic (no -ffast-math, no contraction).
#pragma once

#include <cmath>
#include <type_traits>

namespace unfurl {

// In the width that every 64-bit processor computes with, and that of AVX2.
typedef double DoublePair __attribute__((vector_size(16)));
typedef double DoubleFour __attribute__((vector_size(32)));

// What rounding takes from a product p = a b, by one instruction of the processor: for code that is compiled
// for it and runs where there is one.
inline void rest_of_product(double a, double b, double p, double& rest) {
  rest = std::fma(a, b, -p);
}
#if defined(__x86_64__)
[[gnu::target("fma")]] inline void rest_of_product(const DoublePair& a, const DoublePair& b,
                                                   const DoublePair& p, DoublePair& rest) {
  rest = __builtin_ia32_vfmaddpd(a, b, -p);
}
[[gnu::target("avx2,fma")]] inline void rest_of_product(const DoubleFour& a, const DoubleFour& b,
                                                        const DoubleFour& p, DoubleFour& rest) {
  rest = __builtin_ia32_vfmaddpd256(a, b, -p);
}
#else
inline void rest_of_product(const DoublePair& a, const DoublePair& b, const DoublePair& p, DoublePair& rest) {
  rest = DoublePair{std::fma(a[0], b[0], -p[0]), std::fma(a[1], b[1], -p[1])};
}
#endif

// T: double, or a vector of doubles for several such numbers at once.
template <class T>
struct TwofoldOf {
  T hi{}, lo{};

  TwofoldOf() = default;
  TwofoldOf(const T& x) : hi(x) {}  // implicit: every double is one
  static TwofoldOf of(const T& high, const T& low) {
    TwofoldOf out(high);
    out.lo = low;
    return out;
  }
  explicit operator double() const requires std::is_same_v<T, double> { return hi + lo; }

  // a + b without rounding.
  static TwofoldOf sum(const T& a, const T& b) {
    const T s = a + b, c = s - a;
    return of(s, (a - (s - c)) + (b - c));
  }
  // The same for |a| >= |b|.
  static TwofoldOf quick_sum(const T& a, const T& b) {
    const T s = a + b;
    return of(s, b - (s - a));
  }
  // a b without rounding; |a|, |b| below 1e300. Fused: by rest_of_product(), to the same bits.
  template <bool fused = false>
  static TwofoldOf product(const T& a, const T& b) {
    const T p = a * b;
    T rest;
    if constexpr (fused) {
      rest_of_product(a, b, p, rest);
    } else {
      constexpr double split = 134217729.0;  // 2^27 + 1
      const T a1 = split * a - (split * a - a), a2 = a - a1;
      const T b1 = split * b - (split * b - b), b2 = b - b1;
      rest = ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
    }
    return of(p, rest);
  }
  template <bool fused>
  static TwofoldOf times(const TwofoldOf& a, const TwofoldOf& b) {
    const TwofoldOf p = product<fused>(a.hi, b.hi);
    return quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }

  friend TwofoldOf operator+(const TwofoldOf& a, const TwofoldOf& b) {
    const TwofoldOf s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
    const TwofoldOf u = quick_sum(s.hi, s.lo + t.hi);
    return quick_sum(u.hi, u.lo + t.lo);
  }
  friend TwofoldOf operator-(const TwofoldOf& a) { return of(-a.hi, -a.lo); }
  friend TwofoldOf operator-(const TwofoldOf& a, const TwofoldOf& b) { return a + -b; }
  friend TwofoldOf operator*(const TwofoldOf& a, const TwofoldOf& b) { return times<false>(a, b); }
  // Of one Newton step on 1 / a.
  friend TwofoldOf inverse(const TwofoldOf& a) {
    const TwofoldOf x = 1.0 / a.hi;
    return x + x * (1.0 - a * x);
  }
};
using Twofold = TwofoldOf<double>;

// Two at once: the same operations on each, so the same bits.
using TwofoldPair = TwofoldOf<DoublePair>;
inline TwofoldPair both(const Twofold& a, const Twofold& b) {
  return TwofoldPair::of(DoublePair{a.hi, b.hi}, DoublePair{a.lo, b.lo});
}
inline Twofold one_of(const TwofoldPair& two, int k) {
  return Twofold::of(two.hi[k], two.lo[k]);
}

}  // namespace unfurl
