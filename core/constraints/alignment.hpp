// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/constraints/constraint.hpp"

namespace unfurl {

// Nodes that stay on a common line or plane which moves with them. l: the mean rod length.
//
//   collinear  nodes a, b, c: Phi = (b - a) x (c - a) / l, three rows of rank two (which two depends on where
//              the line points, so all are kept; one is implied, and not counted); quadratic;
//              derivatives are taken across the line
//   coplanar   nodes a, b, c, d: Phi = ((b - a) x (c - a)) . (d - a) / l^2, one row; cubic
std::unique_ptr<ConstraintBlock> collinear_block(const Structure& structure);
std::unique_ptr<ConstraintBlock> coplanar_block(const Structure& structure);

}  // namespace unfurl
