// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "render/scene/look.hpp"

namespace unfurl::testing {

inline double distance(const Color& a, const Color& b) {
  return std::hypot(static_cast<double>(a.r - b.r), static_cast<double>(a.g - b.g),
                    static_cast<double>(a.b - b.b));
}

// Groups of rods are told apart: so are colours as far from each other as the two groups that are nearest.
inline double told_apart(const Look& look) {
  double least = 1;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, distance(look.group(i), look.group(j)));
  return least;
}

}  // namespace unfurl::testing
