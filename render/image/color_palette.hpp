// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/image/image.hpp"

namespace unfurl {

// At most so many colours that stand for all colours of some pictures: median cut (Heckbert 1982), dividing
// the set of colours with the largest squared error at its mean.
class ColorPalette {
 public:
  explicit ColorPalette(std::size_t colors) : most_(colors) {}

  void sample(const Image& image);  // before the first nearest(); fully transparent pixels do not count
  void choose();
  using Rgb = std::array<std::uint8_t, 3>;
  const std::vector<Rgb>& colors() const { return colors_; }
  std::uint8_t nearest(const std::uint8_t* rgb);  // index of the nearest colour

 private:
  struct Cell {  // of a grid of colours: how many pixels, and the sum of their colours
    double count = 0;
    std::array<double, 3> sum{};
  };
  static std::size_t cell_of(const std::uint8_t* rgb);

  std::size_t most_;
  std::vector<Cell> cells_;
  std::vector<Rgb> colors_;
  std::vector<std::int16_t> known_;  // nearest colour by cell; -1: not asked yet
};

}  // namespace unfurl
