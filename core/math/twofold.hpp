// SPDX-License-Identifier: BSD-3-Clause
// Numbers of twice the digits: an unevaluated sum of two doubles, hi + lo with |lo| <= ulp(hi) / 2, relative
// precision 2^-104 (Dekker 1971, Numer. Math. 18; Knuth, The Art of Computer Programming 2, 4.2.2). Right
// only where the compiler keeps to IEEE arithmetic (no -ffast-math, no contraction).
#pragma once

#include <cmath>
#include <type_traits>

namespace unfurl {

// T: double, or a vector of doubles for several such numbers at once.
template <class T>
struct TwofoldOf {
  T hi{}, lo{};

  TwofoldOf() = default;
  TwofoldOf(T x) : hi(x) {}  // implicit: every double is one
  static TwofoldOf of(T high, T low) {
    TwofoldOf out(high);
    out.lo = low;
    return out;
  }
  explicit operator double() const requires std::is_same_v<T, double> { return hi + lo; }

  // a + b without rounding.
  static TwofoldOf sum(T a, T b) {
    const T s = a + b, c = s - a;
    return of(s, (a - (s - c)) + (b - c));
  }
  // The same for |a| >= |b|.
  static TwofoldOf quick_sum(T a, T b) {
    const T s = a + b;
    return of(s, b - (s - a));
  }
  // a b without rounding; |a|, |b| below 1e300.
  static TwofoldOf product(T a, T b) {
    constexpr double split = 134217729.0;  // 2^27 + 1
    const T a1 = split * a - (split * a - a), a2 = a - a1;
    const T b1 = split * b - (split * b - b), b2 = b - b1;
    const T p = a * b;
    return of(p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2);
  }

  friend TwofoldOf operator+(const TwofoldOf& a, const TwofoldOf& b) {
    const TwofoldOf s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
    const TwofoldOf u = quick_sum(s.hi, s.lo + t.hi);
    return quick_sum(u.hi, u.lo + t.lo);
  }
  friend TwofoldOf operator-(const TwofoldOf& a) { return of(-a.hi, -a.lo); }
  friend TwofoldOf operator-(const TwofoldOf& a, const TwofoldOf& b) { return a + -b; }
  friend TwofoldOf operator*(const TwofoldOf& a, const TwofoldOf& b) {
    const TwofoldOf p = product(a.hi, b.hi);
    return quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }
  // Of one Newton step on 1 / a.
  friend TwofoldOf inverse(const TwofoldOf& a) {
    const TwofoldOf x = 1.0 / a.hi;
    return x + x * (1.0 - a * x);
  }
};
using Twofold = TwofoldOf<double>;

// Two at once, in the width that every 64-bit processor computes with: the same operations on each, so the
// same bits.
typedef double DoublePair __attribute__((vector_size(16)));
using TwofoldPair = TwofoldOf<DoublePair>;
inline TwofoldPair both(const Twofold& a, const Twofold& b) {
  return TwofoldPair::of(DoublePair{a.hi, b.hi}, DoublePair{a.lo, b.lo});
}
inline Twofold one_of(const TwofoldPair& two, int k) {
  return Twofold::of(two.hi[k], two.lo[k]);
}

}  // namespace unfurl
