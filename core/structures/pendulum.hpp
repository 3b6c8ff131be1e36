// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// A rigid rod that hangs from a fixed point, with a bob at its tip. It starts at `angle` from the downward
// vertical in the plane of x and z; `angle_rate` swings it in that plane, `azimuth_rate` turns the plane
// about the vertical. Without an azimuth rate it is the plane pendulum, with the rate
//
//     Omega^2 = g l (m/2 + M) / (I cos(angle)),   I = (m/3 + M) l^2
//
// the conical one.
const std::vector<ParamSpec>& pendulum_params();
Structure build_pendulum(const ParamSet& params);

}  // namespace unfurl
