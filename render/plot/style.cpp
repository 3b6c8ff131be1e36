// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/style.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/plot/group_colors.hpp"

namespace unfurl {
namespace {

constexpr FigureColor hex(unsigned rgb) {
  return {static_cast<float>(rgb >> 16 & 255) / 255.0f, static_cast<float>(rgb >> 8 & 255) / 255.0f,
          static_cast<float>(rgb & 255) / 255.0f, 1.0f};
}

// After Okabe and Ito (2008), darkened until every colour holds its own on white; the smallest difference of
// two colours under simulated protanopia, deuteranopia and tritanopia is checked by the tests.
constexpr std::array<FigureColor, palette_size> colors{hex(0x0B5FA5), hex(0xC8400B), hex(0x17926B),
                                                       hex(0x8B2D6E), hex(0xB48B08), hex(0x3A98D6),
                                                       hex(0x222222), hex(0x6E6E6E)};

// Shades of the same, for what comes after the eighth: darker ones of the light, paler ones of the dark.
constexpr std::array<FigureColor, palette_size> shades{hex(0x06305A), hex(0x6B2206), hex(0x0A4A36),
                                                       hex(0xC06AA3), hex(0x5E4904), hex(0x1C5C8A),
                                                       hex(0x8A7F74), hex(0x3F4A52)};

// Beyond the sixth the same in other shades, as pictures have them (Look::group).
FigureColor group_color_on_white(int k) {
  constexpr int count = static_cast<int>(group_colors_on_pale.size());
  const auto& [r, g, b] = group_colors_on_pale[static_cast<std::size_t>(k % count)];
  const int round = k / count;
  const FigureColor& to = round % 2 == 1 ? plot::ink : plot::white;
  const float share = round == 0 ? 0.0f : round % 4 < 3 ? 0.5f : 0.75f;
  FigureColor c{r + share * (to.r - r), g + share * (to.g - g), b + share * (to.b - b), 1};
  while (plot::contrast_on_white(c) < 3) c = {0.99f * c.r, 0.99f * c.g, 0.99f * c.b, 1};
  return c;
}

}  // namespace

FigureColor palette(int i) {
  if (i >= first_group_color) return group_color_on_white(i - first_group_color);
  constexpr int all = 2 * palette_size;
  const int k = (i % all + all) % all;
  return k < palette_size ? colors[static_cast<std::size_t>(k)]
                          : shades[static_cast<std::size_t>(k - palette_size)];
}

FigureColor map_color(double u) {
  constexpr std::array<FigureColor, 10> stops{hex(0x440154), hex(0x482878), hex(0x3E4A89), hex(0x31688E),
                                              hex(0x26828E), hex(0x1F9E89), hex(0x35B779), hex(0x6DCD59),
                                              hex(0xB4DE2C), hex(0xFDE725)};
  const double at = (u > 0 ? std::min(u, 1.0) : 0.0) * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const auto share = static_cast<float>(at - static_cast<double>(i));
  const auto mix = [share](float a, float b) { return a + (b - a) * share; };
  const FigureColor &a = stops[i], &b = stops[i + 1];
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), 1.0f};
}

FigureColor plot::lighter(FigureColor c, float share) {
  const auto mix = [share](float v) { return v + (1.0f - v) * share; };
  return {mix(c.r), mix(c.g), mix(c.b), c.a};
}

double plot::contrast_on_white(FigureColor c) {
  const auto linear = [](float v) {
    return v <= 0.04045f ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);  // sRGB, IEC 61966-2-1
  };
  return 1.05 / (0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b) + 0.05);
}

FigureColor plot::readable(FigureColor c) {
  while (contrast_on_white(c) < 4.5) c = {0.95f * c.r, 0.95f * c.g, 0.95f * c.b, c.a};
  return c;
}

}  // namespace unfurl
