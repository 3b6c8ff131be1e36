// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/color_palette.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

constexpr int bits = 6;  // of each channel that tell cells apart
constexpr std::size_t cell_count = std::size_t{1} << (3 * bits);

struct Point {
  std::array<double, 3> color;
  double count;
};

struct Box {
  std::vector<Point> points;
  std::array<double, 3> mean{};
  int axis = 0;      // of the largest squared error
  double error = 0;  // along that axis

  explicit Box(std::vector<Point> p) : points(std::move(p)) {
    double count = 0;
    for (const Point& x : points) {
      count += x.count;
      for (std::size_t c = 0; c < 3; ++c) mean[c] += x.count * x.color[c];
    }
    for (double& m : mean) m /= count;
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (const Point& x : points) sum += x.count * (x.color[c] - mean[c]) * (x.color[c] - mean[c]);
      if (sum > error) error = sum, axis = static_cast<int>(c);
    }
  }
};

}  // namespace

std::size_t ColorPalette::cell_of(const std::uint8_t* rgb) {
  constexpr int drop = 8 - bits;
  return (static_cast<std::size_t>(rgb[0] >> drop) << (2 * bits)) |
         (static_cast<std::size_t>(rgb[1] >> drop) << bits) | static_cast<std::size_t>(rgb[2] >> drop);
}

void ColorPalette::sample(const Image& image) {
  if (cells_.empty()) cells_.resize(cell_count);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    if (image.rgba[i + 3] == 0) continue;
    Cell& cell = cells_[cell_of(&image.rgba[i])];
    cell.count += 1;
    for (std::size_t c = 0; c < 3; ++c) cell.sum[c] += image.rgba[i + c];
  }
}

void ColorPalette::choose() {
  std::vector<Point> points;
  for (const Cell& cell : cells_) {
    // Small and saturated parts matter to the eye more than their area: count by the square root.
    if (cell.count > 0)
      points.push_back({{cell.sum[0] / cell.count, cell.sum[1] / cell.count, cell.sum[2] / cell.count},
                        std::sqrt(cell.count)});
  }
  colors_.clear();
  known_.assign(cell_count, -1);
  if (points.empty()) points.push_back({{0, 0, 0}, 1});
  std::vector<Box> boxes;
  boxes.emplace_back(std::move(points));
  while (boxes.size() < most_) {
    const auto worst = std::max_element(boxes.begin(), boxes.end(),
                                        [](const Box& a, const Box& b) { return a.error < b.error; });
    if (worst->error <= 0) break;
    const auto axis = static_cast<std::size_t>(worst->axis);
    const double cut = worst->mean[axis];
    const auto middle = std::partition(worst->points.begin(), worst->points.end(),
                                       [&](const Point& p) { return p.color[axis] <= cut; });
    if (middle == worst->points.begin() || middle == worst->points.end()) break;
    std::vector<Point> low(worst->points.begin(), middle), high(middle, worst->points.end());
    *worst = Box(std::move(low));
    boxes.emplace_back(std::move(high));
  }
  for (const Box& box : boxes)
    colors_.push_back({static_cast<std::uint8_t>(std::lround(box.mean[0])),
                       static_cast<std::uint8_t>(std::lround(box.mean[1])),
                       static_cast<std::uint8_t>(std::lround(box.mean[2]))});
}

std::uint8_t ColorPalette::nearest(const std::uint8_t* rgb) {
  std::int16_t& known = known_[cell_of(rgb)];
  if (known >= 0) return static_cast<std::uint8_t>(known);
  int best = 1 << 30;
  for (std::size_t k = 0; k < colors_.size(); ++k) {
    int distance = 0;
    for (std::size_t c = 0; c < 3; ++c) distance += (rgb[c] - colors_[k][c]) * (rgb[c] - colors_[k][c]);
    if (distance < best) best = distance, known = static_cast<std::int16_t>(k);
  }
  return static_cast<std::uint8_t>(known);
}

}  // namespace unfurl
