// SPDX-License-Identifier: BSD-3-Clause
// [[forces]] of a scene into a structure: the kinds are those of the force table (forces/force.hpp).
#include <cmath>

#include "core/scene/element_members.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {

namespace {

const ForceKind& force_kind(std::string_view kind) {
  for (const ForceKind& row : force_kinds())
    if (row.kind == kind) return row;
  throw std::logic_error("no force kind " + std::string(kind));
}

// What all forces of an entry have in common, once for each node or other member that it names.
std::vector<Force> forces_on(const SceneElement& e, Members members, MemberFinder& find) {
  Force one;
  one.kind = e.kind;
  one.name = e.name;
  std::vector<Force> forces;
  const auto measured = [&](const std::optional<Measure>& measure) {
    if (!measure) return;
    one.measure = *measure;
    one.rest = find.initial(*measure);
    forces.push_back(one);
  };
  switch (members) {
    case Members::none:
      forces.push_back(one);
      break;
    case Members::each_node:
      for (const int node : find.nodes(e, true)) {
        forces.push_back(one);
        forces.back().nodes = {node};
      }
      break;
    case Members::node_list:
      one.nodes = find.nodes(e, true);
      if (!one.nodes.empty()) forces.push_back(one);
      break;
    case Members::rod:
      if (const Rod* rod = find.rod(e, 0)) {
        one.nodes = {rod->a, rod->b};
        forces.push_back(one);
      }
      break;
    case Members::two_nodes:
      measured(length_of(e, find));
      break;
    case Members::angle:
      measured(angle_of(e, find));
      break;
    case Members::measure:
      measured(measure_of(e, find));
      break;
  }
  return forces;
}

void add_force(const SceneElement& e, ElementAdder& to) {
  const ForceKind& kind = force_kind(e.kind);
  if (e.kind == "offload" && to.structure.gravity.isZero(0.0))
    to.structure.notes.push_back(
        problem_text({e.where, e.key, "does nothing without a weight: gravity.acceleration is 0"}));
  for (Force& force : forces_on(e, kind.members, to.find)) {
    try {
      kind.fill(e.values, force);
    } catch (const StructureError& error) {
      return to.find.problem(e, error.key, error.message);
    }
    to.structure.forces.push_back(std::move(force));
  }
}

}  // namespace

const std::vector<ElementKind>& scene_forces() {
  static const std::vector<ElementKind> kinds = [] {
    std::vector<ElementKind> found;
    for (const ForceKind& row : force_kinds())
      if (row.params)
        found.push_back({row.kind, row.help, row.members, row.params, add_force,
                         row.members == Members::two_nodes ? length_of
                         : row.members == Members::angle   ? angle_of
                         : row.members == Members::measure ? measure_of
                                                           : nullptr});
    return found;
  }();
  return kinds;
}

}  // namespace unfurl
