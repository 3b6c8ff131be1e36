// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/image_scale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace unfurl {
namespace {

// The pixels that pixel i of `small` covers of `large` in one direction, and how much of each.
struct Share {
  int first;
  std::vector<float> weights;
};

std::vector<Share> shares(int large, int small) {
  std::vector<Share> all;
  const double step = static_cast<double>(large) / small;
  for (int i = 0; i < small; ++i) {
    const double low = i * step, high = std::min<double>((i + 1) * step, large);
    Share share{static_cast<int>(low), {}};
    for (int k = share.first; k < high - 1e-9; ++k)
      share.weights.push_back(
          static_cast<float>((std::min<double>(k + 1, high) - std::max<double>(k, low)) / step));
    all.push_back(std::move(share));
  }
  return all;
}

std::uint8_t rounded(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
}

}  // namespace

Image scaled_down(const Image& image, int width, int height) {
  if (width > image.width || height > image.height || width < 1 || height < 1)
    throw std::invalid_argument("scaled_down: the size is not smaller");
  if (width == image.width && height == image.height) return image;
  const std::vector<Share> across = shares(image.width, width), down = shares(image.height, height);
  Image out{width, height, {}};
  out.rgba.reserve(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const Share& row : down) {
    for (const Share& column : across) {
      std::array<float, 3> sum{};
      float alpha = 0;
      for (std::size_t y = 0; y < row.weights.size(); ++y) {
        const std::size_t line =
            (static_cast<std::size_t>(row.first) + y) * static_cast<std::size_t>(image.width);
        const std::uint8_t* pixel = &image.rgba[4 * (line + static_cast<std::size_t>(column.first))];
        for (const float weight : column.weights) {
          const float a = row.weights[y] * weight * static_cast<float>(pixel[3]);
          for (std::size_t c = 0; c < 3; ++c) sum[c] += a * static_cast<float>(pixel[c]);
          alpha += a;
          pixel += 4;
        }
      }
      for (const float c : sum) out.rgba.push_back(rounded(alpha > 0 ? c / alpha : 0));
      out.rgba.push_back(rounded(alpha));
    }
  }
  return out;
}

Image before_wall(Image image, const std::array<std::uint8_t, 3>& wall) {
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const int a = image.rgba[i + 3];
    if (a == 255) continue;
    for (std::size_t c = 0; c < 3; ++c)
      image.rgba[i + c] =
          static_cast<std::uint8_t>((a * image.rgba[i + c] + (255 - a) * wall[c] + 127) / 255);
    image.rgba[i + 3] = 255;
  }
  return image;
}

Image side_by_side(const std::vector<Image>& images) {
  Image out;
  if (images.empty()) return out;
  out.height = images.front().height;
  for (const Image& image : images) {
    if (image.height != out.height) throw std::invalid_argument("side_by_side: the heights differ");
    out.width += image.width;
  }
  for (int y = 0; y < out.height; ++y) {
    for (const Image& image : images) {
      const auto row = image.rgba.begin() + 4 * static_cast<std::ptrdiff_t>(y) * image.width;
      out.rgba.insert(out.rgba.end(), row, row + 4 * static_cast<std::ptrdiff_t>(image.width));
    }
  }
  return out;
}

Image stacked(Image upper, const Image& lower) {
  if (upper.width != lower.width) throw std::invalid_argument("stacked: the widths differ");
  upper.height += lower.height;
  upper.rgba.insert(upper.rgba.end(), lower.rgba.begin(), lower.rgba.end());
  return upper;
}

}  // namespace unfurl
