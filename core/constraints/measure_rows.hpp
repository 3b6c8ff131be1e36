// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/constraints/constraint.hpp"

namespace unfurl {

// Holds or drives a measure s(q) (core/structure/measure.hpp), one row each, in metres:
//
//     Phi(q, t) = l (s(q) - f(t)),   G = l ds/dq,   curvature = l Hess s
//
// with l = 1 for lengths and coordinates and row_arm() for angles, whose difference is taken to the
// nearest turn, so that a crank may go round; angles in a combination (a gear, a cable drum) count their
// turns instead. The multiplier times l is the force or torque against s; what a
// motor must give along s is its opposite.
std::unique_ptr<ConstraintBlock> measure_block(const Structure& structure);

// l of an angle: the shortest edge that it is taken between at t = 0, so that its row is known to what
// rounding the nodes leaves. Of the fold angle, and of edges without a length, the structure's mean rod [m].
double row_arm(const Structure& structure, const Measure& measure);

}  // namespace unfurl
