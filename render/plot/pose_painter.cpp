#include "render/plot/pose_painter.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot/style.hpp"

namespace unfurl::plot {
namespace {

constexpr double edge = 0.8;       // of white on each side of a rod [points]
constexpr float farthest = 0.45f;  // share of white in the colour of what lies farthest

struct Item {
  double depth;
  const Segment* segment;
  const Dot* dot;
};

}  // namespace

void paint_pose(const Panel& panel, const PanelLayout& layout, Canvas& canvas) {
  std::vector<Item> items;
  for (const Segment& s : panel.segments) items.push_back({s.depth, &s, nullptr});
  for (const Dot& d : panel.dots) items.push_back({d.depth, nullptr, &d});
  if (items.empty()) return;
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.depth < b.depth; });
  const double nearest = items.back().depth, range = nearest - items.front().depth;
  const auto faded = [&](int color, double depth) {
    return lighter(palette(color),
                   range > 0 ? farthest * static_cast<float>((nearest - depth) / range) : 0.0f);
  };
  const Scale &x = layout.x.scale, &y = layout.y.scale;
  for (const Item& item : items) {
    if (item.dot) {
      const Dot& d = *item.dot;
      canvas.circle({x(d.x), y(d.y)}, d.radius, faded(d.color, d.depth));
      continue;
    }
    const Segment& s = *item.segment;
    const Point a{x(s.x0), y(s.y0)}, b{x(s.x1), y(s.y1)};
    // The white edge stops short of the ends, where rods meet in a joint.
    const double length = std::hypot(b.x - a.x, b.y - a.y),
                 inset = std::max(0.15, (s.width + 3 * edge) / length);
    const Point from{a.x + inset * (b.x - a.x), a.y + inset * (b.y - a.y)};
    const Point to{b.x - inset * (b.x - a.x), b.y - inset * (b.y - a.y)};
    if (inset < 0.5) canvas.line(from, to, {white, s.width + 2 * edge});
    canvas.line(a, b, {faded(s.color, s.depth), s.width});
  }
}

}  // namespace unfurl::plot
