// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// N four-bar windows side by side in the plane z = 0, the classic test of singular poses: 2 N + 1 equal
// uniform rods of length l and mass m. Ground pins A_i at (i l, 0), i = 0..N; uprights A_i B_i from (i l, 0)
// to (i l, l); bars B_i B_{i+1}. Every B_i starts with the speed v in +x. While all windows stay
// parallelograms there is one degree of freedom, the turn phi of the uprights, B_i = (i l + l sin phi, l cos
// phi). At phi = 90 and 270 deg all rods are collinear: there each window could turn into an
// anti-parallelogram instead.
const std::vector<ParamSpec>& four_bar_ladder_params();
Structure build_four_bar_ladder(const ParamSet& params);

}  // namespace unfurl
