// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// A mast of N cells along z. Every face of a cell is a scissor: two rods of length l that cross and are
// pinned at their middles. With the fold angle theta between rods and axis, all cells have
//
//     height h = l cos(theta),  side w = l sin(theta)
//
// sides = 1: planar, in the plane of x and z. L_i stand at x = 0, R_i at x = w; L0 is fixed, R0 slides on x.
// sides = n >= 3: corners A_i, B_i, ... at polar angles 2 pi k / n and radius w / (2 sin(pi/n)); those of
// level 0 slide on radial rails in step.
//
// A rod is one rigid rod through its pin: the pin is a massless node at its middle (a linear relation).
const std::vector<ParamSpec>& scissor_mast_params();
Structure build_scissor_mast(const ParamSet& params);

}  // namespace unfurl
