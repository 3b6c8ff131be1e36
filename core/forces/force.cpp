// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/force.hpp"

#include <array>

#include "core/forces/bending.hpp"
#include "core/forces/constant_forces.hpp"
#include "core/forces/damping.hpp"
#include "core/forces/elastic_rods.hpp"
#include "core/forces/friction.hpp"
#include "core/forces/latch_spring.hpp"
#include "core/forces/motor.hpp"
#include "core/forces/offload.hpp"
#include "core/forces/spring.hpp"
#include "core/forces/temperature.hpp"
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
      ForceKind{"elastic_rod", "rods that give: structure.rod_model = \"elastic\"", elastic_rods_block},
      ForceKind{"rod_damping", "damping of rods that give: damping_ratio or damping_time", rod_dampers_block},
      ForceKind{"bending", "bending stiffness at the node between two segments of a rod", bending_block,
                Members::three_nodes, bending_params, fill_bending},
      ForceKind{"temperature", "rods change their length with a temperature over time", no_block,
                Members::rods, temperature_params, fill_temperature},
      ForceKind{"torsion_spring", "spring and damper at the hinge between two rods, or on the fold angle",
                torsion_spring_block, Members::angle, torsion_spring_params, fill_torsion_spring},
      ForceKind{"cable", "a cable over nodes in order, which runs freely: elastic, or paid out and drawn in",
                cable_block, Members::path, cable_params, fill_cable},
      ForceKind{"combination", "spring and damper on a sum of lengths, coordinates and angles",
                combination_block, Members::terms, combination_params, fill_combination},
      ForceKind{"motor", "a motor at the hinge between two rods, or on the fold angle, through a gear",
                motor_block, Members::angle, motor_params, fill_motor},
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
