// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/pose_painter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/plot/style.hpp"

namespace unfurl::plot {
namespace {

constexpr double halo = 0.9;  // of white on each side of a rod where it passes in front of another [points]
constexpr double least_halo = 0.2;      // below which it does not show
constexpr double most_gap = 0.2;        // of the length of the shorter of two rods that cross
constexpr float farthest = 0.45f;       // share of white in the colour of what lies farthest
constexpr std::size_t most_rods = 600;  // crossings of more are not looked for: they are too small to see

struct Item {
  double depth;
  const Segment* segment;
  const Dot* dot;
};

struct Stroke {
  Point a, b;
  double width;
};

// Part the stroke behind where `front` crosses it, but not where both end in one joint or run side by side.
void part(const Stroke& front, const Stroke& behind, Canvas& canvas) {
  const double dx = front.b.x - front.a.x, dy = front.b.y - front.a.y;
  const double ex = behind.b.x - behind.a.x, ey = behind.b.y - behind.a.y;
  const double length = std::hypot(dx, dy), cross = dx * ey - dy * ex;
  const double sine = std::abs(cross) / std::max(length * std::hypot(ex, ey), 1e-12);
  if (sine < 0.2) return;
  const double wx = behind.a.x - front.a.x, wy = behind.a.y - front.a.y;
  const double u = (wx * ey - wy * ex) / cross, v = (wx * dy - wy * dx) / cross;
  // A gap that would take much of a short rod says less than the rod.
  const double shorter = std::min(length, std::hypot(ex, ey));
  const double gap = std::min(halo, 0.5 * (most_gap * shorter * sine - front.width));
  if (gap < least_halo) return;
  const double half = (behind.width / 2 + 0.3) / sine / length;
  if (u < half || u > 1 - half || v < 0.02 || v > 0.98) return;
  canvas.line({front.a.x + (u - half) * dx, front.a.y + (u - half) * dy},
              {front.a.x + (u + half) * dx, front.a.y + (u + half) * dy}, {white, front.width + 2 * gap});
}

// Joints hide no rods: of those that are drawn short they are small, but no thinner than a rod.
double largest_joint(const Panel& panel, const PanelLayout& layout) {
  constexpr double most = 0.2;  // of the median length of the rods
  if (panel.segments.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> lengths;
  double thinnest = std::numeric_limits<double>::infinity();
  for (const Segment& s : panel.segments) {
    lengths.push_back(
        std::hypot(layout.x.scale(s.x1) - layout.x.scale(s.x0), layout.y.scale(s.y1) - layout.y.scale(s.y0)));
    thinnest = std::min<double>(thinnest, s.width);
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return std::max(most * *middle, 0.5 * thinnest);
}

}  // namespace

void paint_pose(const Panel& panel, const PanelLayout& layout, Canvas& canvas) {
  std::vector<Item> items;
  for (const Segment& s : panel.segments) items.push_back({s.depth, &s, nullptr});
  for (const Dot& d : panel.dots) items.push_back({d.depth, nullptr, &d});
  if (items.empty()) return;
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.depth < b.depth; });
  const Scale &x = layout.x.scale, &y = layout.y.scale;
  const double nearest = items.back().depth, range = std::max(nearest - items.front().depth, x.hi - x.lo);
  const auto faded = [&](int color, double depth) {
    return lighter(palette(color), farthest * static_cast<float>((nearest - depth) / range));
  };
  const double most_radius = largest_joint(panel, layout);
  std::vector<Stroke> drawn;
  for (const Item& item : items) {
    if (item.dot) {
      const Dot& d = *item.dot;
      canvas.circle({x(d.x), y(d.y)}, std::min<double>(d.radius, most_radius), faded(d.color, d.depth));
      continue;
    }
    const Segment& s = *item.segment;
    const Stroke stroke{{x(s.x0), y(s.y0)}, {x(s.x1), y(s.y1)}, s.width};
    if (panel.segments.size() <= most_rods)
      for (const Stroke& behind : drawn) part(stroke, behind, canvas);
    canvas.line(stroke.a, stroke.b, {faded(s.color, s.depth), s.width});
    drawn.push_back(stroke);
  }
}

}  // namespace unfurl::plot
