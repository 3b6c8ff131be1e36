// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Gravity offload: node i hangs on a rope of the length H from a trolley at x_t, and the rope carries the
// weight m_i g of the node and of the rods' share in it (its row of the mass matrix). For ropes much longer
// than the way, with P = 1 - g g^T / |g|^2,
//
//     F_i = -m_i g - k P (x_i - x_t),   k = m_i |g| / H,   V = m_i g . x_i + k/2 |P (x_i - x_t)|^2
//
// A trolley that follows is always above the node: k = 0. One that stays makes a free mass swing with the
// period 2 pi sqrt(H / |g|).
std::unique_ptr<ForceBlock> offload_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& offload_params();
void fill_offload(const ParamSet& values, Force& force);

}  // namespace unfurl
