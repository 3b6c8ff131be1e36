// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/shutter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "render/scene/view.hpp"

namespace unfurl {
namespace {

// How far what is drawn gets from one picture to the other, at most [pixels].
double way_between(const DrawList& a, const DrawList& b, int width, int height) {
  double most = 0;
  const auto add = [&](const Vec3f& from, const Vec3f& to) {
    const Vec3f p = project(a.camera, width, height, from), q = project(b.camera, width, height, to);
    if (p.z() > 0 && q.z() > 0) most = std::max(most, static_cast<double>((q - p).head<2>().norm()));
  };
  for (std::size_t k = 0; k < std::min(a.tubes.size(), b.tubes.size()); ++k)
    add(a.tubes[k].a, b.tubes[k].a), add(a.tubes[k].b, b.tubes[k].b);
  for (std::size_t k = 0; k < std::min(a.balls.size(), b.balls.size()); ++k)
    add(a.balls[k].center, b.balls[k].center);
  return most;
}

void move_eye(DrawList& list, double radius, double angle) {
  const Vec3f forward = list.camera.target - list.camera.eye;
  const Vec3f right = forward.cross(list.camera.up).normalized(), up = right.cross(forward).normalized();
  const auto wide = static_cast<float>(radius * static_cast<double>(forward.norm()));
  list.camera.eye +=
      wide * (static_cast<float>(std::cos(angle)) * right + static_cast<float>(std::sin(angle)) * up);
}

// So many that one does not stand beside the next as a body of its own: along a line, or over a disc.
int exposures(const FrameBuilder& builder, const DrawList& first, const Shot& shot, double depth_of_field,
              const Framebuffer& size) {
  constexpr double most = 96, thin = 1.0 / 180;  // of the picture: a thin rod
  const double apart = thin * std::min(size.width(), size.height());
  double count = depth_of_field > 0 ? 24 : 12;
  if (shot.open > 0) {
    double way = 0;
    DrawList before = first;
    for (const double share : {0.5, 1.0}) {  // what turns is where it was after a turn
      Shot part = shot;
      part.t += share * shot.open;
      const DrawList next = builder.build(part);
      way += way_between(before, next, size.width(), size.height());
      before = next;
    }
    count = std::max(count, way / apart);
  }
  if (depth_of_field > 0) {
    DrawList edge = first;
    move_eye(edge, 0.5 * depth_of_field, 0);
    const double radius = way_between(first, edge, size.width(), size.height());
    count = std::max(count, 4 * pi * radius * radius / (apart * apart));  // edges show it sooner
  }
  return static_cast<int>(std::min(most, std::ceil(count)));
}

}  // namespace

Image exposed(Renderer& renderer, const FrameBuilder& builder, const Shot& shot, double depth_of_field,
              const std::function<void()>& between) {
  if (between) between();
  const DrawList first = builder.build(shot);
  const bool moving = shot.open > 0, lens = depth_of_field > 0 && first.camera.parallel_height <= 0;
  if (shot.card || (!moving && !lens)) return renderer.draw(first);
  std::vector<std::uint32_t> sum;
  Image image;
  const int count = exposures(builder, first, shot, lens ? depth_of_field : 0, renderer.picture());
  for (int i = 0; i < count; ++i) {
    if (between) between();
    Shot part = shot;
    part.t += shot.open * (i + 0.5) / count;
    DrawList list = moving ? builder.build(part) : first;
    list.labels = first.labels, list.lines = first.lines, list.areas = first.areas, list.inset = first.inset;
    // Places at equal areas of the lens, turned by the golden angle.
    if (lens) move_eye(list, 0.5 * depth_of_field * std::sqrt((i + 0.5) / count), 2.399963 * i);
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
