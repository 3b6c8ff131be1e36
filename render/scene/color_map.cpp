// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/color_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace unfurl {
namespace {

using Rgb = std::array<int, 3>;

template <std::size_t n>
Color along(const std::array<Rgb, n>& stops, double x) {
  const double at = (std::isfinite(x) ? std::clamp(x, 0.0, 1.0) : 0.0) * (n - 1);
  const auto i = std::min(static_cast<std::size_t>(at), n - 2);
  const double u = at - static_cast<double>(i);
  const auto mix = [&](std::size_t c) {
    return static_cast<float>(((1 - u) * stops[i][c] + u * stops[i + 1][c]) / 255);
  };
  return {mix(0), mix(1), mix(2), 1};
}

}  // namespace

Color diverging_color(double x) {
  static constexpr std::array<Rgb, 7> stops{{{40, 60, 180},
                                             {66, 104, 214},
                                             {98, 134, 218},
                                             {148, 148, 148},
                                             {206, 114, 88},
                                             {196, 66, 52},
                                             {165, 5, 35}}};
  return along(stops, 0.5 + 0.5 * x);
}

Color sequential_color(double x) {
  static constexpr std::array<Rgb, 6> stops{
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  return along(stops, x);
}

}  // namespace unfurl
