#include "render/plot/style.hpp"

#include <array>

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

}  // namespace

FigureColor palette(int i) {
  const int k = (i % palette_size + palette_size) % palette_size;
  return colors[static_cast<std::size_t>(k)];
}

FigureColor plot::lighter(FigureColor c, float share) {
  const auto mix = [share](float v) { return v + (1.0f - v) * share; };
  return {mix(c.r), mix(c.g), mix(c.b), c.a};
}

}  // namespace unfurl
