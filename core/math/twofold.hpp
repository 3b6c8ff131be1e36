// SPDX-License-Identifier: BSD-3-Clause
// Numbers of twice the digits: an unevaluated sum of two doubles, hi + lo with |lo| <= ulp(hi) / 2, relative
// precision 2^-104 (Dekker 1971, Numer. Math. 18; Knuth, The Art of Computer Programming 2, 4.2.2). Right
// only where the compiler keeps to IEEE arithmetic (no -ffast-math, no contraction).
#pragma once

#include <cmath>

namespace unfurl {

struct Twofold {
  double hi = 0, lo = 0;

  Twofold() = default;
  Twofold(double x) : hi(x) {}  // implicit: every double is one
  explicit operator double() const { return hi + lo; }

  // a + b without rounding.
  static Twofold sum(double a, double b) {
    const double s = a + b, c = s - a;
    return {s, (a - (s - c)) + (b - c)};
  }
  // The same for |a| >= |b|.
  static Twofold quick_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  // a b without rounding; |a|, |b| below 1e300.
  static Twofold product(double a, double b) {
    constexpr double split = 134217729.0;  // 2^27 + 1
    const double a1 = split * a - (split * a - a), a2 = a - a1;
    const double b1 = split * b - (split * b - b), b2 = b - b1;
    const double p = a * b;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
  }

  friend Twofold operator+(const Twofold& a, const Twofold& b) {
    const Twofold s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
    const Twofold u = quick_sum(s.hi, s.lo + t.hi);
    return quick_sum(u.hi, u.lo + t.lo);
  }
  friend Twofold operator-(const Twofold& a) { return {-a.hi, -a.lo}; }
  friend Twofold operator-(const Twofold& a, const Twofold& b) { return a + -b; }
  friend Twofold operator*(const Twofold& a, const Twofold& b) {
    const Twofold p = product(a.hi, b.hi);
    return quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }
  // Of one Newton step on 1 / a.
  friend Twofold inverse(const Twofold& a) {
    const Twofold x = 1.0 / a.hi;
    return x + x * (1.0 - a * x);
  }

 private:
  Twofold(double high, double low) : hi(high), lo(low) {}
};

}  // namespace unfurl
