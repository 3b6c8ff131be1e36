// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/forces/force.hpp"

namespace unfurl {

// A temperature over time is no force but changes rods: l(t) = l (1 + expansion dT(t)) is the target of a
// rigid rod's row (constraints/rod_length.cpp), the length without force of one that gives
// (forces/elastic_rods.hpp).
std::unique_ptr<ForceBlock> no_block(const Structure& structure, const SparseRows& node_mass);
const std::vector<ParamSpec>& temperature_params();
void fill_temperature(const ParamSet& values, Force& force);

}  // namespace unfurl
