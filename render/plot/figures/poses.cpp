// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <set>

#include "core/structure/shown_lines.hpp"
#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/pose_view.hpp"
#include "render/plot/figures/rod_groups.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

constexpr int rows = 2, columns = 3;
constexpr std::size_t poses = rows * columns;

// With as many decimals as tell a twentieth of the run.
std::string time_text(double t, double span) {
  const double fine = span > 0 ? std::ceil(-std::log10(span / 20)) : 0;
  return plot::format_fixed(t, static_cast<int>(std::clamp(fine, 2.0, 12.0))) + " s";
}

struct Shot {
  double t;
  std::string title;
};

// Six equal steps of the deployed fraction where the run unfolds from its start to its end without turning
// back; an empty list where it does not.
std::vector<Shot> moments_of_deployment(const Diagnostics& d) {
  const Series* fraction = d.find("deployed_fraction");
  if (!fraction) return {};
  const std::vector<double>& f = fraction->values;
  if (f.size() < poses || !std::is_sorted(f.begin(), f.end()) || f.back() - f.front() < 0.05) return {};
  std::vector<Shot> moments;
  for (std::size_t k = 0; k < poses; ++k) {
    const double wanted = f.front() + (f.back() - f.front()) * static_cast<double>(k) / (poses - 1);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(std::lower_bound(f.begin(), f.end(), wanted) - f.begin(), 1,
                                   static_cast<std::ptrdiff_t>(f.size()) - 1));
    const double step = f[i] - f[i - 1], u = step > 0 ? (wanted - f[i - 1]) / step : 0.0;
    const double t = k == 0           ? d.t.front()
                     : k == poses - 1 ? d.t.back()
                                      : d.t[i - 1] + u * (d.t[i] - d.t[i - 1]);
    moments.push_back({t, time_text(t, d.t.back() - d.t.front()) + ", " + plot::format_share(wanted)});
  }
  return moments;
}

std::vector<Shot> equal_moments(const Trajectory& run) {
  std::vector<Shot> moments;
  for (std::size_t k = 0; k < poses; ++k) {
    const double t =
        run.start_time() + (run.end_time() - run.start_time()) * static_cast<double>(k) / (poses - 1);
    moments.push_back({t, time_text(t, run.end_time() - run.start_time())});
  }
  return moments;
}

// 1, 2 or 5 times a power of ten: about a third of the width.
double bar_length(double width) {
  const double power = std::pow(10.0, std::floor(std::log10(width / 3)));
  for (const double m : {5.0, 2.0})
    if (m * power <= width / 3 * 1.001) return m * power;
  return power;
}

class PosePainter {
 public:
  PosePainter(const Structure& s, const PoseView& view)
      : structure_(s), lines_(lines_between_nodes(s)), view_(view), groups_(rod_groups(s)) {
    const double many = std::sqrt(60.0 / static_cast<double>(std::max<std::size_t>(s.rod_copies.size(), 1)));
    width_ = static_cast<float>(std::clamp(1.3 * many, 0.4, 1.5));
    color_.assign(s.rods.size(), 0);
    for (const RodGroup& g : groups_)
      for (const int r : g.rods) color_[static_cast<std::size_t>(r)] = g.color;
    for (const Constraint& c : s.constraints)
      if (c.kind == "fixed") fixed_.insert(c.nodes.begin(), c.nodes.end());
  }

  Vec3 project(const Vec3& p) const { return view_.project(p); }

  Panel panel(const VectorXd& q, const std::string& title) const {
    Panel p;
    p.title = title;
    p.bare = p.equal_scale = true;
    std::vector<double> front(structure_.node_copies.size(), -1e300);  // depth of the nearest rod at a node
    for (const RodCopy& rod : structure_.rod_copies) {
      const Vec3 a = project(pose_node(q, rod.a)), b = project(pose_node(q, rod.b));
      const double depth = (a.z() + b.z()) / 2;
      p.segments.push_back(
          {a.x(), a.y(), b.x(), b.y(), depth, color_[static_cast<std::size_t>(rod.source)], width_});
      for (const int n : {rod.a, rod.b})
        front[static_cast<std::size_t>(n)] = std::max(front[static_cast<std::size_t>(n)], depth);
    }
    for (const ShownLine& line : lines_) {
      const Vec3 a = project(pose_node(q, line.a)), b = project(pose_node(q, line.b));
      p.segments.push_back(
          {a.x(), a.y(), b.x(), b.y(), (a.z() + b.z()) / 2, line_color(line.group), 0.5f * width_});
    }
    for (std::size_t i = 0; i < structure_.node_copies.size(); ++i) {
      const Vec3 at = project(pose_node(q, static_cast<int>(i)));
      const bool fixed = fixed_.count(structure_.node_copies[i].source) > 0;
      p.dots.push_back({at.x(), at.y(), std::max(front[i], at.z()), 6, (fixed ? 1.4f : 0.75f) * width_});
    }
    return p;
  }

  // The legend, as curves without points; false where there is but one group of rods.
  bool name_groups(Panel& p) const {
    const auto name = [&](const std::string& label, int color, float width) {
      Curve c;
      c.label = label;
      c.color = color;
      c.width = width;
      p.curves.push_back(std::move(c));
    };
    if (groups_.size() > 1 || !lines_.empty())
      for (const RodGroup& g : groups_) name(g.name, g.color, Curve{}.width);
    std::set<std::string> named;
    for (const ShownLine& line : lines_)
      if (named.insert(line.group).second) name(line.group, line_color(line.group), 0.6f);
    return groups_.size() > 1;
  }

 private:
  static int line_color(const std::string& group) {  // about as pictures have them
    return group == "spring" ? 7 : group == "net" ? 6 : group == "actuator" ? 4 : 1;
  }

  const Structure& structure_;
  std::vector<ShownLine> lines_;
  PoseView view_;
  std::vector<RodGroup> groups_;
  std::vector<int> color_;
  std::set<int> fixed_;
  float width_ = 1;
};

}  // namespace

Figure poses_figure(const Simulation& run, const Diagnostics& diagnostics) {
  const Structure& structure = run.trajectory.structure();
  std::vector<Shot> moments = moments_of_deployment(diagnostics);
  const bool by_fraction = !moments.empty();
  if (!by_fraction) moments = equal_moments(run.trajectory);
  std::vector<VectorXd> q;
  PoseBox space;
  for (const Shot& m : moments) {
    q.push_back(run.trajectory.positions_at(m.t));
    for (int i = 0; i < q.back().size() / 3; ++i) space.add(pose_node(q.back(), i));
  }
  const PoseView view = pose_view(space.size(), structure.gravity);
  const PosePainter painter(structure, view);
  PoseBox page;
  for (const VectorXd& pose : q)
    for (int i = 0; i < pose.size() / 3; ++i) page.add(painter.project(pose_node(pose, i)));
  const Vec3 size = page.size().cwiseMax(1e-3 * std::max(page.size().maxCoeff(), 1e-9));

  Figure f;
  f.name = "poses";
  f.title = "Configuration at six times";
  f.rows = rows, f.columns = columns;
  for (std::size_t k = 0; k < moments.size(); ++k) {
    Panel p = painter.panel(q[k], moments[k].title);
    p.x.min = page.lo.x() - 0.02 * size.x(), p.x.max = page.hi.x() + 0.02 * size.x();
    p.y.min = page.lo.y() - 0.02 * size.y(), p.y.max = page.hi.y() + 0.02 * size.y();
    f.panels.push_back(std::move(p));
  }
  const bool colored = painter.name_groups(f.panels.front());
  Panel& corner = f.panels[columns];
  // Panels about 48 mm wide, as high as the motion is, with room for titles and caption; wider than a motion
  // that is higher than this.
  constexpr double wide = 48, rest = 25, title = 7;
  f.height_mm = std::clamp(rows * (wide * size.y() / size.x() + title) + rest, 60.0, 130.0);
  const double high = (f.height_mm - rest) / rows - title;
  corner.scale_bar = bar_length(std::max(size.x(), size.y() * wide / high));
  corner.scale_bar_label = plot::format_number(corner.scale_bar, 2) + " m";
  f.caption = view.flat ? "View of the plane of motion, drawn to one scale."
                        : "Axonometric view, drawn to one scale.";
  if (by_fraction) f.caption += " The poses are equal steps of the deployed fraction apart.";
  if (colored) f.caption += " Rods are coloured by group.";
  f.caption += " " + method_sentence(run);
  return f;
}

}  // namespace unfurl
