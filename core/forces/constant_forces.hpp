// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Constant forces on nodes (the [[loads]] of a scene, the hinge forces of a hoop).
std::unique_ptr<ForceBlock> nodal_load_block(const Structure& structure, const SparseRows& node_mass);

// M (g, g, ..., g): the weight of rods and nodes, distributed as the mass matrix distributes them.
std::unique_ptr<ForceBlock> gravity_block(const Structure& structure, const SparseRows& node_mass);

}  // namespace unfurl
