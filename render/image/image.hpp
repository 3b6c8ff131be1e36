// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace unfurl {

// Pixels, row 0 at the top, 8-bit RGBA (not premultiplied, sRGB-encoded).
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height
};

}  // namespace unfurl
