// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/pushed_model.hpp"

#include <algorithm>
#include <stdexcept>

namespace unfurl {

std::shared_ptr<const Model> pushed_model(const Model& model, std::size_t own, int node, const Vec3& force) {
  if (node < 0 || static_cast<std::size_t>(node) >= model.structure.nodes.size())
    throw std::out_of_range("no solved node has the index " + std::to_string(node));
  Structure structure = model.structure;
  const auto begin = structure.loads.begin() + static_cast<std::ptrdiff_t>(own);
  const auto pushed =
      std::find_if(begin, structure.loads.end(), [&](const Load& l) { return l.node == node; });
  const Vec3 before = pushed == structure.loads.end() ? Vec3(Vec3::Zero()) : pushed->force;
  if (before == force) return nullptr;
  if (pushed == structure.loads.end())
    structure.loads.push_back({node, force});
  else
    pushed->force = force;
  System system = model.system.loaded(structure);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

}  // namespace unfurl
