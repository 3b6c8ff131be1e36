// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/damping.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/forces/spring.hpp"
#include "core/math/factors.hpp"

namespace unfurl {
namespace {

class Drag final : public ForceBlock {
 public:
  explicit Drag(const Structure& structure) {
    for (const Force& f : structure.forces)
      if (f.kind == "drag") points_.push_back({f.nodes[0], f.damping});
  }
  bool empty() const { return points_.empty(); }
  bool constant() const override { return false; }
  bool has_power() const override { return true; }
  bool dissipative() const override { return true; }
  void add(const Moment&, const double*, const double* v, double scale, double* f) const override {
    for (const auto& [node, c] : points_)
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(node)) -= scale * c * node_vector(v, node);
  }
  double power(const Moment&, const double*, const double* v) const override {
    double sum = 0;
    for (const auto& [node, c] : points_) sum -= c * node_vector(v, node).squaredNorm();
    return sum;
  }
  void derivatives(const Moment&, const double*, const double*, ForceDerivative&,
                   ForceDerivative& by_v) const override {
    for (const auto& [node, c] : points_)
      for (int k = 0; k < 3; ++k) by_v.emplace_back(3 * node + k, 3 * node + k, -c);
  }

 private:
  std::vector<std::pair<int, double>> points_;
};

// Relations between the nodes that hold a pin on a rod.
class PinRelations {
 public:
  PinRelations(const Structure& structure, int pin) : s_(structure), pin_(pin), known_{pin} {
    for (const Constraint& c : s_.constraints)
      if (c.kind == "relation" && has(c.nodes, pin))
        known_.insert(known_.end(), c.nodes.begin(), c.nodes.end());
  }

  // Do they say that the pin is the point of the rod at which it lies, between its ends?
  bool on(const Rod& rod) const {
    if (known_.size() == 1 || rod.a == pin_ || rod.b == pin_) return false;
    const Vec3 a = at(rod.a), d = at(rod.b) - a, p = at(pin_) - a;
    const double share = p.dot(d) / d.squaredNorm();
    if (!(share > 0 && share < 1 && (p - share * d).norm() <= 1e-6 * d.norm())) return false;
    std::map<int, Index> place{{pin_, 0}, {rod.a, 3}, {rod.b, 6}};
    for (const int n : known_) place.try_emplace(n, 3 * std::ssize(place));
    MatrixXd point = MatrixXd::Zero(3 * std::ssize(place), 3);
    point.topRows<9>() << Mat3::Identity(), (share - 1) * Mat3::Identity(), -share * Mat3::Identity();
    std::vector<const Constraint*> rows;
    for (const Constraint& c : s_.constraints)
      if (c.kind == "relation" &&
          std::all_of(c.nodes.begin(), c.nodes.end(), [&](int n) { return place.contains(n); }))
        rows.push_back(&c);
    MatrixXd held = MatrixXd::Zero(point.rows(), std::ssize(rows));
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t k = 0; k < rows[r]->nodes.size(); ++k)
        held.block<3, 1>(place.at(rows[r]->nodes[k]), static_cast<Index>(r)) += rows[r]->vectors[k];
    return rows.size() >= 3 && (held * fitted_columns(held, point) - point).norm() <= 1e-6;
  }

 private:
  static bool has(const std::vector<int>& nodes, int n) {
    return std::find(nodes.begin(), nodes.end(), n) != nodes.end();
  }
  Vec3 at(int node) const { return s_.nodes[static_cast<std::size_t>(node)].position; }

  const Structure& s_;
  int pin_;
  std::vector<int> known_;  // of relations of the pin itself
};

std::vector<ParamSpec> one_damping(const char* unit, const char* help) {
  return {required(positive_param("damping", unit, 1.0, help))};
}

}  // namespace

std::unique_ptr<ForceBlock> drag_block(const Structure& structure, const SparseRows&) {
  auto block = std::make_unique<Drag>(structure);
  if (block->empty()) return nullptr;
  return block;
}

std::vector<RodAtJoint> rods_at_joint(const Structure& structure, int joint) {
  const PinRelations relations(structure, joint);
  std::vector<RodAtJoint> out;
  for (std::size_t i = 0; i < structure.rods.size(); ++i) {
    const Rod& rod = structure.rods[i];
    if (rod.a == joint || rod.b == joint)
      out.push_back({i, joint, rod.a == joint ? rod.b : rod.a});
    else if (relations.on(rod))
      out.push_back({i, rod.a, rod.b});
  }
  return out;
}

std::vector<Measure> angles_at_joint(const Structure& structure, int joint) {
  const std::vector<RodAtJoint> lines = rods_at_joint(structure, joint);
  std::vector<Measure> angles;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = i + 1; j < lines.size(); ++j)
      angles.push_back({MeasureKind::angle,
                        {lines[i].from, lines[i].to, lines[j].from, lines[j].to},
                        Vec3::Zero(),
                        0,
                        {}});
  return angles;
}

void note_idle_joints(Structure& structure) {
  std::map<std::string, std::pair<bool, std::string>> entries;  // does any of its nodes have two rods? nodes
  for (const Force& f : structure.forces) {
    if (f.kind != "joint_damping") continue;
    auto& [acts, nodes] = entries[f.name];
    acts = acts || !angles_at_joint(structure, f.nodes[0]).empty();
    nodes += (nodes.empty() ? "" : ", ") + structure.nodes[static_cast<std::size_t>(f.nodes[0])].name;
  }
  for (const auto& [name, entry] : entries)
    if (!entry.first)
      structure.notes.push_back("force \"" + name + "\" does nothing: no two rods meet at " + entry.second);
}

std::unique_ptr<ForceBlock> joint_damping_block(const Structure& structure, const SparseRows&) {
  std::vector<Force> dampers;
  for (const Force& f : structure.forces) {
    if (f.kind != "joint_damping") continue;
    for (const Measure& angle : angles_at_joint(structure, f.nodes[0])) {
      dampers.push_back(f);
      dampers.back().stiffness = 0;
      dampers.back().measure = angle;
    }
  }
  return spring_block(dampers, structure.deployment);
}

const std::vector<ParamSpec>& joint_damping_params() {
  static const auto params = one_damping("N m s/rad", "torque per rad/s between any two rods at the node");
  return params;
}

void fill_damping(const ParamSet& values, Force& force) {
  force.damping = values.real("damping");
}

const std::vector<ParamSpec>& drag_params() {
  static const auto params = one_damping("N s/m", "force against the velocity of the node");
  return params;
}

}  // namespace unfurl
