// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "core/math/types.hpp"

namespace unfurl {

// A function of what moves on straight lines, q + t v, at t = 0: its value and its derivatives by t.
struct Course {
  double value, first, second;
};

inline Course operator*(const Course& a, const Course& b) {
  return {a.value * b.value, a.value * b.first + b.value * a.first,
          a.value * b.second + b.value * a.second + 2 * a.first * b.first};
}

inline Course operator-(const Course& a, const Course& b) {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}

inline Course root(const Course& a) {
  const double r = std::sqrt(a.value), first = a.first / (2 * r);
  return {r, first, (a.second / 2 - first * first) / r};
}

// a . b of two vectors with their rates
inline Course dot(const Vec3& a, const Vec3& a_rate, const Vec3& b, const Vec3& b_rate) {
  return {a.dot(b), a.dot(b_rate) + a_rate.dot(b), 2 * a_rate.dot(b_rate)};
}

// The second derivative of atan2(s, c).
inline double second_of_angle(const Course& s, const Course& c) {
  const double r2 = s.value * s.value + c.value * c.value;
  return (c.value * s.second - s.value * c.second) / r2 +
         2 *
             (s.value * c.value * (c.first * c.first - s.first * s.first) +
              (s.value * s.value - c.value * c.value) * s.first * c.first) /
             (r2 * r2);
}

}  // namespace unfurl
