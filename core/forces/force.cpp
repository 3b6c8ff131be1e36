#include "core/forces/force.hpp"

#include <array>

#include "core/forces/constant_forces.hpp"

namespace unfurl {

std::span<const ForceKind> force_kinds() {
  static const std::array kinds{
      ForceKind{"load", "a constant force on nodes: [[loads]] nodes, force (N)", nodal_load_block},
      ForceKind{"gravity", "weight of rods and nodes: [gravity] acceleration (m/s^2)", gravity_block},
  };
  return kinds;
}

}  // namespace unfurl
