// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/force.hpp"

#include <array>

#include "core/forces/constant_forces.hpp"
#include "core/forces/damping.hpp"
#include "core/forces/friction.hpp"
#include "core/forces/latch_spring.hpp"
#include "core/forces/offload.hpp"
#include "core/forces/spring.hpp"
#include "core/forces/varying_loads.hpp"

namespace unfurl {

std::span<const ForceKind> force_kinds() {
  static const std::array kinds{
      ForceKind{"load", "a constant force on nodes: [[loads]] nodes, force (N)", nodal_load_block},
      ForceKind{"gravity", "weight of rods and nodes: [gravity] acceleration (m/s^2)", gravity_block},
      ForceKind{"load_over_time", "a force on nodes that changes with time", load_over_time_block,
                Members::each_node, load_over_time_params, fill_load_over_time},
      ForceKind{"follower", "a force along a rod that turns with it", follower_block, Members::rod,
                follower_params, fill_follower},
      ForceKind{"spring", "spring and damper between two nodes; tension_only: a cable", axial_spring_block,
                Members::two_nodes, axial_spring_params, fill_axial_spring},
      ForceKind{"torsion_spring", "spring and damper at the hinge between two rods, or on the fold angle",
                torsion_spring_block, Members::angle, torsion_spring_params, fill_torsion_spring},
      ForceKind{"joint_damping", "viscous torque between the rods that meet at a node", joint_damping_block,
                Members::each_node, joint_damping_params, fill_damping},
      ForceKind{"drag", "viscous force on nodes", drag_block, Members::each_node, drag_params, fill_damping},
      ForceKind{"friction", "dry friction on a hinge, a length or a coordinate: it sticks or slips",
                friction_block, Members::measure, friction_params, fill_friction},
      ForceKind{"offload", "gravity offload of a laboratory test: each node hangs with its weight on a rope",
                offload_block, Members::each_node, offload_params, fill_offload},
      ForceKind{
          "latch",
          "what locks the structure at solver.at_deployed = \"latch\" gives way: a spring and damper on "
          "each latch, from then on",
          latch_spring_block, Members::none, latch_spring_params, fill_latch_spring},
  };
  return kinds;
}

}  // namespace unfurl
