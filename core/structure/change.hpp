// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/types.hpp"

namespace unfurl {

// A function of what moves from q to q + u: its value at q and what u changes of it. Nothing cancels in that:
// its round-off is relative to u.
struct Change {
  double value, change;
};

inline Change operator*(const Change& a, const Change& b) {
  return {a.value * b.value, a.value * b.change + a.change * (b.value + b.change)};
}

inline Change operator-(const Change& a, const Change& b) {
  return {a.value - b.value, a.change - b.change};
}

inline Change root(const Change& a) {
  const double before = std::sqrt(a.value), after = std::sqrt(std::max(a.value + a.change, 0.0));
  return {before, before + after > 0 ? a.change / (before + after) : 0.0};
}

// a . b of two vectors with what they change by
inline Change dot_change(const Vec3& a, const Vec3& a_by, const Vec3& b, const Vec3& b_by) {
  return {a.dot(b), a.dot(b_by) + a_by.dot(b + b_by)};
}

// By what atan2(s, c) changes, to the nearest turn: the angle from (c, s) to where these two go.
inline double change_of_angle(const Change& s, const Change& c) {
  return std::atan2(c.value * s.change - s.value * c.change,
                    c.value * (c.value + c.change) + s.value * (s.value + s.change));
}

}  // namespace unfurl
