// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "render/image/image.hpp"

namespace unfurl {

// The picture at another size, not larger than it is: every pixel is the mean of the area that it covers,
// weighted by alpha.
Image scaled_down(const Image& image, int width, int height);

// The picture before a wall, without transparency.
Image before_wall(Image image, const std::array<std::uint8_t, 3>& wall);

// Pictures of one height, from left to right.
Image side_by_side(const std::vector<Image>& images);

// One picture above another of the same width.
Image stacked(Image upper, const Image& lower);

}  // namespace unfurl
