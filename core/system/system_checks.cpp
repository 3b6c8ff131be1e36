// SPDX-License-Identifier: BSD-3-Clause
// What a System refuses.
#include <algorithm>

#include "core/structure/structure_error.hpp"
#include "core/system/system_data.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

// Every constraint must be in some block and every force of a kind of [[forces]], or it would not act and
// nobody would know.
void System::Data::check_kinds(const Structure& structure) const {
  std::vector<char> taken(structure.constraints.size());
  for (const ConstraintBlock* block : all)
    for (int r = 0; r < block->rows(); ++r)
      if (const int source = block->source(r); source >= 0) taken[static_cast<std::size_t>(source)] = 1;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (!taken[i])
      throw StructureError("constraints[" + std::to_string(i) + "].kind",
                           "there is no constraint kind \"" + structure.constraints[i].kind + "\"");
  for (std::size_t i = 0; i < structure.forces.size(); ++i)
    if (std::ranges::none_of(force_kinds(), [&](const ForceKind& kind) {
          return kind.params && kind.kind == structure.forces[i].kind;
        }))
      throw StructureError("forces[" + std::to_string(i) + "].kind",
                           "there is no force kind \"" + structure.forces[i].kind + "\"");
}

// A coordinate without inertia has no equation of motion.
void System::Data::check_mass(const Structure& structure) const {
  for (Index i = 0; i < mass.rows(); ++i)
    if (!(mass.coeff(i, i) > 0)) {
      const auto node = static_cast<std::size_t>(free_coordinates[static_cast<std::size_t>(i)] / 3);
      for (const Constraint& c : structure.constraints)
        if (c.kind == "measure" && c.measure.kind == MeasureKind::coordinate &&
            c.measure.nodes == std::vector{static_cast<int>(node)})
          throw StructureError("nodes[" + std::to_string(node) + "].mass",
                               "node " + structure.nodes[node].name + " has no mass, and " +
                                   in_quotes(c.name) +
                                   " holds or drives what has one: give it a mass, or hold it by kind = "
                                   "\"plane\"");
      throw StructureError(
          "nodes[" + std::to_string(node) + "].mass",
          "node " + structure.nodes[node].name +
              " can move but has no mass: give it a mass, or a mass to a rod that ends there");
    }
}

}  // namespace unfurl
