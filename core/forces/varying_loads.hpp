// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// Forces whose work is not a difference of potentials.
//   load_over_time   F = size(t) direction on a node
//   follower         F = size(t) d / |d| on the node at the rod's second end, d along the rod: turns with it,
//                    and is tangent to one that was cut to bend
std::unique_ptr<ForceBlock> load_over_time_block(const Structure& structure, const SparseRows& node_mass);
std::unique_ptr<ForceBlock> follower_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& load_over_time_params();
const std::vector<ParamSpec>& follower_params();
void fill_load_over_time(const ParamSet& values, Force& force);
void fill_follower(const ParamSet& values, Force& force);

}  // namespace unfurl
