// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/self_stress.hpp"
#include "core/structure/shown_lines.hpp"
#include "core/system/rigid_twin.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "render/plot/figures/kinds.hpp"
#include "render/plot/figures/pose_view.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

constexpr std::size_t most_states = 12;  // that are drawn
// Of the palette; tension is red and compression blue, as in pictures.
constexpr int tension = 1, compression = 0, other = 3, idle = 7;

// A pose in the middle of what happens: nearest to half deployed, else half of the run's states.
std::size_t chosen_state(const Diagnostics& d) {
  const Series* fraction = d.find("deployed_fraction");
  if (!fraction) return d.t.size() / 2;
  const auto& f = fraction->values;
  const auto nearest = std::min_element(
      f.begin(), f.end(), [](double a, double b) { return std::abs(a - 0.5) < std::abs(b - 0.5); });
  return static_cast<std::size_t>(nearest - f.begin());
}

class StatePainter {
 public:
  StatePainter(const Model& model, const VectorXd& q, const VectorXd& whole)
      : structure_(model.structure), whole_(whole), jacobian_(model.system.all_jacobian(q)) {
    PoseBox space, page;
    const auto nodes = static_cast<int>(structure_.node_copies.size());
    for (int i = 0; i < nodes; ++i) space.add(pose_node(whole_, i));
    view_ = pose_view(space.size(), structure_.gravity);
    for (int i = 0; i < nodes; ++i) page.add(at(i));
    size_ = page.size().cwiseMax(1e-3 * std::max(page.size().maxCoeff(), 1e-9));
    low_ = page.lo, nearest_ = page.hi.z();
  }

  Vec3 size() const { return size_; }

  Panel panel(const SelfStress& state, const std::string& title) const {
    Panel p;
    p.title = title;
    p.bare = p.equal_scale = true;
    p.x.min = low_.x() - 0.06 * size_.x(), p.x.max = low_.x() + 1.06 * size_.x();
    p.y.min = low_.y() - 0.06 * size_.y(), p.y.max = low_.y() + 1.06 * size_.y();
    std::vector<double> force(structure_.rods.size(), 0.0);
    std::set<int> held;  // solved nodes
    const int first_rod = static_cast<int>(jacobian_.rows()) - static_cast<int>(force.size());
    for (const auto& member : state.members) {
      if (member.row >= first_rod)
        force[static_cast<std::size_t>(member.row - first_rod)] = member.force;
      else
        for (SparseRows::InnerIterator it(jacobian_, member.row); it; ++it)
          if (it.value() != 0.0) held.insert(static_cast<int>(it.col()) / 3);
    }
    add_rods(force, p);
    for (std::size_t i = 0; i < structure_.node_copies.size(); ++i) {
      if (held.count(structure_.node_copies[i].source) == 0) continue;
      const Vec3 x = at(static_cast<int>(i));
      p.dots.push_back({x.x(), x.y(), nearest_, other, 1.3f});
    }
    return p;
  }

 private:
  Vec3 at(int node) const { return view_.project(pose_node(whole_, node)); }
  double behind() const { return 1e3 * size_.norm(); }  // far, of all that is drawn [m]

  void add_rods(const std::vector<double>& force, Panel& p) const {
    for (const RodCopy& rod : structure_.rod_copies) {
      const double f = force[static_cast<std::size_t>(rod.source)];
      const Vec3 a = at(rod.a), b = at(rod.b);
      // What carries nothing lies behind.
      const double depth = (a.z() + b.z()) / 2 - (f == 0.0 ? behind() : 0.0);
      const auto width = static_cast<float>(f == 0.0 ? 0.4 : 0.6 + 1.8 * std::abs(f));
      p.segments.push_back({a.x(), a.y(), b.x(), b.y(), depth,
                            f > 0   ? tension
                            : f < 0 ? compression
                                    : idle,
                            width, f});
    }
    for (const ShownLine& line : lines_between_nodes(structure_)) {
      const Vec3 a = at(line.a), b = at(line.b);
      p.segments.push_back({a.x(), a.y(), b.x(), b.y(), (a.z() + b.z()) / 2 - 2 * behind(), idle, 0.4f});
    }
  }

  const Structure& structure_;
  const VectorXd& whole_;
  SparseRows jacobian_;
  PoseView view_;
  Vec3 size_, low_;
  double nearest_ = 0;  // depth of what is nearest [m]
};

void name_colors(Panel& p) {
  const std::pair<const char*, int> names[] = {
      {"tension", tension}, {"compression", compression}, {"no force", idle}, {"at held nodes", other}};
  for (const auto& [label, color] : names) {
    Curve c;
    c.label = label;
    c.color = color;
    p.curves.push_back(std::move(c));
  }
}

}  // namespace

Figure self_stress_figure(const Simulation& run, const Diagnostics& diagnostics) {
  const Trajectory& trajectory = run.trajectory;
  const std::size_t i = chosen_state(diagnostics);
  const VectorXd q = trajectory.node_positions(i), whole = trajectory.positions(i);
  Structure rods = rigid_twin(trajectory.model(i).structure, q);
  System rows(rods, run.options.eliminate_linear);
  const Model model{std::move(rods), std::move(rows)};
  const ForceBalance balance = force_balance(model.system, q, analyse_mobility(model.system, q));
  const std::size_t states = balance.states.size(), drawn = std::min(states, most_states);

  Figure f;
  f.name = "self_stress";
  f.title = "States of self-stress";
  f.columns = drawn <= 1 ? 1 : drawn <= 4 ? 2 : drawn <= 9 ? 3 : 4;
  f.rows = static_cast<int>((std::max<std::size_t>(drawn, 1) + static_cast<std::size_t>(f.columns) - 1) /
                            static_cast<std::size_t>(f.columns));
  const StatePainter painter(model, q, whole);
  for (std::size_t k = 0; k < drawn; ++k)
    f.panels.push_back(painter.panel(
        balance.states[k],
        std::to_string(k + 1) + ": " + std::to_string(balance.states[k].members.size()) + " members"));
  if (f.panels.empty()) f.panels.emplace_back();
  f.panels.resize(static_cast<std::size_t>(f.rows * f.columns), [] {
    Panel empty;
    empty.bare = true;
    return empty;
  }());
  name_colors(f.panels.front());
  const double wide = 150.0 / f.columns;
  f.height_mm =
      std::clamp(f.rows * (wide * painter.size().y() / painter.size().x() + 7.0) + 30.0, 60.0, 200.0);
  f.caption =
      "Forces that balance each other without any load: any multiple of " +
      (states == 1 ? std::string("the one state") : "each of the " + std::to_string(states) + " states") +
      (drawn < states ? ", of which the first " + std::to_string(drawn) + " are drawn," : "") +
      " may be added to the rod forces of the rigid model. The width of a line is the size of the "
      "force, all signs of a state may be turned round. Pose at " +
      plot::format_number(trajectory.time(i), 4) + " s.";
  return f;
}

}  // namespace unfurl
