// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "core/forces/force.hpp"

namespace unfurl {

// Linear viscous dampers: F = -dR/dv with the dissipation function R = half the dissipated power.
//   joint_damping   at every node with several rods: R = c/2 sum theta'^2 over pairs of them, theta their
//                   angle. Rods have no inertia about their own axis and spin so as to feel no torque there:
//                   of their relative angular velocity only theta' is left.
//   drag            R = c/2 |v|^2 of a node
// Rods are at a node with an end, or carry it as a pin between their ends.
struct RodAtJoint {
  std::size_t rod = 0;
  int from = 0, to = 0;  // nodes along it: the joint and its other end, or both ends
};
std::vector<RodAtJoint> rods_at_joint(const Structure& structure, int joint);
std::vector<Measure> angles_at_joint(const Structure& structure, int joint);
// Notes each entry of the kind of whose nodes none has two rods.
void note_idle_joints(Structure& structure);
std::unique_ptr<ForceBlock> joint_damping_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> drag_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& joint_damping_params();
const std::vector<ParamSpec>& drag_params();
void fill_damping(const ParamSet& values, Force& force);

}  // namespace unfurl
