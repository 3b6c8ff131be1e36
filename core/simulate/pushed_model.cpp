// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/pushed_model.hpp"

#include <algorithm>
#include <stdexcept>

namespace unfurl {

std::shared_ptr<const Model> pushed_model(const Model& model, std::size_t own, int node, const Vec3& force) {
  if (node < 0 || static_cast<std::size_t>(node) >= model.structure.nodes.size())
    throw std::out_of_range("no solved node has the index " + std::to_string(node));
  const std::vector<Load>& loads = model.structure.loads;
  const auto pushed = std::find_if(loads.begin() + static_cast<std::ptrdiff_t>(own), loads.end(),
                                   [&](const Load& l) { return l.node == node; });
  const Vec3 before = pushed == loads.end() ? Vec3(Vec3::Zero()) : pushed->force;
  if (before == force) return nullptr;
  Structure structure = model.structure;
  if (pushed == loads.end())
    structure.loads.push_back({node, force});
  else
    structure.loads[static_cast<std::size_t>(pushed - loads.begin())].force = force;
  System system = model.system.loaded(structure);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

}  // namespace unfurl
