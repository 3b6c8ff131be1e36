// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/rigid_twin.hpp"

namespace unfurl {
namespace {

// What a force has from the places of its nodes at t = 0.
void keep(Force& f, const Structure& structure, const ConstVec& q) {
  const auto start = [&](std::size_t k) {
    return structure.nodes[static_cast<std::size_t>(f.nodes[k])].position;
  };
  const auto now = [&](std::size_t k) { return Vec3(q.segment<3>(3 * static_cast<Index>(f.nodes[k]))); };
  if (f.kind == "offload" && !f.trolley.allFinite()) f.trolley = start(0);
  if (f.kind != "bending") return;
  const auto length = [](const auto& at) { return (at(1) - at(0)).norm() + (at(2) - at(1)).norm(); };
  const double longer = length(now) / length(start);
  f.stiffness *= longer;
  f.damping *= longer;
}

}  // namespace

Structure rigid_twin(const Structure& structure, const ConstVec& q) {
  Structure twin = structure;
  for (Force& f : twin.forces) keep(f, structure, q);
  for (std::size_t i = 0; i < twin.nodes.size(); ++i)
    twin.nodes[i].position = q.segment<3>(3 * static_cast<Index>(i));
  for (Rod& rod : twin.rods) {
    const double length =
        (q.segment<3>(3 * static_cast<Index>(rod.b)) - q.segment<3>(3 * static_cast<Index>(rod.a))).norm();
    if (rod.elastic()) rod.youngs_modulus *= length / rod.natural_length();
    rod.length = length;
    rod.gives = false;
    rod.free_length = rod.expansion = 0.0;
  }
  return twin;
}

}  // namespace unfurl
