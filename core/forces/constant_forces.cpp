// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/constant_forces.hpp"

namespace unfurl {
namespace {

class ConstantForce final : public ForceBlock {
 public:
  explicit ConstantForce(VectorXd force) : force_(std::move(force)) {}
  bool constant() const override { return true; }
  void add(const Moment&, const double*, const double*, double scale, double* f) const override {
    Eigen::Map<VectorXd>(f, force_.size()) += scale * force_;
  }

 private:
  VectorXd force_;
};

}  // namespace

std::unique_ptr<ForceBlock> nodal_load_block(const Structure& structure, const SparseRows&) {
  if (structure.loads.empty()) return nullptr;
  VectorXd force = VectorXd::Zero(3 * static_cast<Index>(structure.nodes.size()));
  for (const Load& load : structure.loads) force.segment<3>(3 * load.node) += load.force;
  return std::make_unique<ConstantForce>(std::move(force));
}

std::unique_ptr<ForceBlock> gravity_block(const Structure& structure, const SparseRows& node_mass) {
  if (structure.gravity.isZero(0.0)) return nullptr;
  const auto n = static_cast<Index>(structure.nodes.size());
  VectorXd weight = node_mass * structure.gravity.replicate(n, 1);
  for (Index i = 0; i < n; ++i)
    if (structure.nodes[static_cast<std::size_t>(i)].ghost) weight.segment<3>(3 * i).setZero();
  return std::make_unique<ConstantForce>(std::move(weight));
}

}  // namespace unfurl
