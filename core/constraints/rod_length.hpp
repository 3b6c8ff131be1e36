// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/constraints/constraint.hpp"

namespace unfurl {

// The length of every rod of the structure. With d = x_b - x_a and l the rod's length
//
//     Phi = (d.d - l^2) / (2 l)        G = [-d/l, d/l]        Hess Phi = [I -I; -I I] / l
//
// so that a row is in metres (to first order the rod's change of length) and its multiplier is the rod's
// axial force in newtons, tension positive.
std::unique_ptr<ConstraintBlock> rod_length_block(const Structure& structure);

}  // namespace unfurl
