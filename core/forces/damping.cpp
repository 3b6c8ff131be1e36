// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/damping.hpp"

#include <utility>

#include "core/forces/spring.hpp"

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

std::vector<ParamSpec> one_damping(const char* unit, const char* help) {
  return {required(positive_param("damping", unit, 1.0, help))};
}

}  // namespace

std::unique_ptr<ForceBlock> drag_block(const Structure& structure, const SparseRows&) {
  auto block = std::make_unique<Drag>(structure);
  if (block->empty()) return nullptr;
  return block;
}

std::unique_ptr<ForceBlock> joint_damping_block(const Structure& structure, const SparseRows&) {
  std::vector<Force> dampers;
  for (const Force& f : structure.forces) {
    if (f.kind != "joint_damping") continue;
    const int joint = f.nodes[0];
    std::vector<int> ends;  // of the rods at the joint
    for (const Rod& rod : structure.rods)
      if (rod.a == joint || rod.b == joint) ends.push_back(rod.a == joint ? rod.b : rod.a);
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        dampers.push_back(f);
        dampers.back().stiffness = 0;
        dampers.back().measure = {MeasureKind::angle, {joint, ends[i], joint, ends[j]}, Vec3::Zero(), 0, {}};
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
