// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/mode_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "core/structure/shown_lines.hpp"
#include "render/plot/figures/pose_view.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

constexpr std::size_t most_shapes = 6;
constexpr double swing = 0.09;  // largest displacement, of the structure's size
constexpr int pose_color = 7, shape_color = 0;

std::vector<std::size_t> drawn_modes(const Vibration& vibration) {
  const auto own = static_cast<std::size_t>(vibration.mechanism_motions);
  const std::size_t elastic = std::min(vibration.modes.size() - own, most_shapes);
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < std::min(own, most_shapes - elastic); ++k) drawn.push_back(k);
  for (std::size_t k = 0; k < elastic; ++k) drawn.push_back(own + k);
  return drawn;
}

std::string mode_title(const VibrationMode& mode, std::size_t number) {
  const std::string head = std::to_string(number + 1) + ": ";
  if (mode.growth > 0) return head + "unstable, " + plot::format_number(mode.growth, 3) + " 1/s";
  if (mode.frequency > 0) return head + plot::format_number(mode.frequency, 4) + " Hz";
  return head + "free";
}

// What is drawn of a pose: rods, cables and springs as thinner lines, and as dots the nodes without a rod.
class Shape {
 public:
  Shape(const Structure& structure, const PoseView& view)
      : structure_(structure),
        view_(view),
        lines_(lines_between_nodes(structure)),
        loose_(structure.node_copies.size(), true) {
    const double many =
        std::sqrt(60.0 / static_cast<double>(std::max<std::size_t>(structure.rod_copies.size(), 1)));
    width_ = std::clamp(1.3 * many, 0.4, 1.5);
    for (const RodCopy& rod : structure.rod_copies)
      for (const int n : {rod.a, rod.b}) loose_[static_cast<std::size_t>(n)] = false;
  }

  void add(const VectorXd& x, int color, double wide, double nearer, Panel& p) const {
    const auto add_line = [&](int from, int to, double width) {
      const Vec3 a = view_.project(pose_node(x, from)), b = view_.project(pose_node(x, to));
      p.segments.push_back({a.x(), a.y(), b.x(), b.y(), (a.z() + b.z()) / 2 + nearer, color,
                            static_cast<float>(wide * width)});
    };
    for (const RodCopy& rod : structure_.rod_copies) add_line(rod.a, rod.b, width_);
    for (const ShownLine& line : lines_) add_line(line.a, line.b, 0.5 * width_);
    for (std::size_t i = 0; i < loose_.size(); ++i) {
      if (!loose_[i]) continue;
      const Vec3 at = view_.project(pose_node(x, static_cast<int>(i)));
      p.dots.push_back({at.x(), at.y(), at.z() + nearer, color, static_cast<float>(1.4 * wide * width_)});
    }
  }

 private:
  const Structure& structure_;
  PoseView view_;
  std::vector<ShownLine> lines_;
  std::vector<bool> loose_;
  double width_ = 1;
};

}  // namespace

Figure mode_shapes_figure(const Structure& structure, const VectorXd& positions, const Vibration& vibration,
                          const std::string& title) {
  const std::vector<std::size_t> drawn = drawn_modes(vibration);
  PoseBox rest;
  for (int i = 0; i < positions.size() / 3; ++i) rest.add(pose_node(positions, i));
  const double extent = rest.size().norm(), amplitude = swing * (extent > 0 ? extent : 1.0);
  PoseBox space = rest;
  std::vector<VectorXd> moved;
  for (const std::size_t k : drawn) {
    moved.push_back(positions + amplitude * vibration.modes[k].shape);
    for (int i = 0; i < positions.size() / 3; ++i) space.add(pose_node(moved.back(), i));
  }
  const PoseView view = pose_view(space.size(), structure.gravity);
  PoseBox page;
  moved.push_back(positions);
  for (const VectorXd& x : moved)
    for (int i = 0; i < x.size() / 3; ++i) page.add(view.project(pose_node(x, i)));
  const Vec3 size = page.size().cwiseMax(1e-3 * std::max(page.size().maxCoeff(), 1e-9));

  Figure f;
  f.name = "modes";
  f.title = "Modes: " + title;
  f.columns = static_cast<int>(std::min<std::size_t>(drawn.size(), 3));
  f.rows = static_cast<int>((drawn.size() + 2) / 3);
  const Shape shape(structure, view);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    Panel p;
    p.title = mode_title(vibration.modes[drawn[k]], drawn[k]);
    p.bare = p.equal_scale = true;
    shape.add(positions, pose_color, 0.6, -1e3 * size.norm(), p);
    shape.add(moved[k], shape_color, 1.0, 0.0, p);
    p.x.min = page.lo.x() - 0.02 * size.x(), p.x.max = page.hi.x() + 0.02 * size.x();
    p.y.min = page.lo.y() - 0.02 * size.y(), p.y.max = page.hi.y() + 0.02 * size.y();
    f.panels.push_back(std::move(p));
  }
  while (f.panels.size() < static_cast<std::size_t>(f.rows * f.columns)) {
    f.panels.emplace_back();
    f.panels.back().bare = true;
  }
  f.height_mm = std::clamp(f.rows * (150.0 / f.columns * size.y() / size.x() + 7.0) + 25.0, 60.0, 160.0);
  f.caption = std::string(view.flat ? "View of the plane of motion" : "Axonometric view") + " at " +
              plot::format_number(vibration.t, 4) +
              " s, the pose in grey, each mode with its largest displacement enlarged to " +
              plot::format_number(100 * swing, 2) + " % of the size. ";
  const std::string all = std::to_string(vibration.modes.size());
  f.caption += vibration.mechanism_motions == 0
                   ? "None of the " + all + " is a motion of the mechanism."
                   : std::to_string(vibration.mechanism_motions) + " of all " + all +
                         " are motions of the mechanism: rods keep their lengths.";
  return f;
}

}  // namespace unfurl
