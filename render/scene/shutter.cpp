// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/shutter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace unfurl {

Image exposed(Renderer& renderer, const FrameBuilder& builder, const Shot& shot, double depth_of_field,
              const std::function<void()>& between) {
  if (between) between();
  const DrawList first = builder.build(shot);
  const bool moving = shot.open > 0, lens = depth_of_field > 0 && first.camera.parallel_height <= 0;
  if (shot.card || (!moving && !lens)) return renderer.draw(first);
  const int count = lens ? 24 : 12;
  std::vector<std::uint32_t> sum;
  Image image;
  for (int i = 0; i < count; ++i) {
    if (between) between();
    Shot part = shot;
    part.t += shot.open * (i + 0.5) / count;
    DrawList list = moving ? builder.build(part) : first;
    list.labels = first.labels, list.lines = first.lines, list.areas = first.areas, list.inset = first.inset;
    if (lens) {  // places at equal areas of the lens, turned by the golden angle
      const Vec3f forward = list.camera.target - list.camera.eye;
      const Vec3f right = forward.cross(list.camera.up).normalized(), up = right.cross(forward).normalized();
      const double r = 0.5 * depth_of_field * std::sqrt((i + 0.5) / count), angle = 2.399963 * i;
      const auto wide = static_cast<float>(r * static_cast<double>(forward.norm()));
      list.camera.eye +=
          wide * (static_cast<float>(std::cos(angle)) * right + static_cast<float>(std::sin(angle)) * up);
    }
    image = renderer.draw(list);
    sum.resize(image.rgba.size(), 0);
    for (std::size_t k = 0; k < sum.size(); k += 4) {
      const std::uint32_t alpha = image.rgba[k + 3];
      for (std::size_t c = k; c < k + 3; ++c) sum[c] += alpha * image.rgba[c];
      sum[k + 3] += alpha;
    }
  }
  // A colour counts by how much of the ground it covers.
  for (std::size_t k = 0; k < sum.size(); k += 4) {
    const std::uint32_t alpha = sum[k + 3];
    for (std::size_t c = k; c < k + 3; ++c)
      image.rgba[c] = static_cast<std::uint8_t>(alpha > 0 ? (sum[c] + alpha / 2) / alpha : 0);
    image.rgba[k + 3] = static_cast<std::uint8_t>((alpha + static_cast<std::uint32_t>(count) / 2) /
                                                  static_cast<std::uint32_t>(count));
  }
  return image;
}

}  // namespace unfurl
