// SPDX-License-Identifier: BSD-3-Clause
// Rod forces that are zero but for rounding: of what drifts or falls freely, or rests without a load.
#pragma once

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// What the rod forces of a run may be off by rounding alone [N]: 1e-12 of the largest force on a node, where
// gravity and each load count by themselves; what the rounding of coordinates and velocities makes of their
// differences, d x = 64 ulp of the structure's size and 8 of its largest coordinate, d v = 64 ulp of the
// largest speed: the masses' way around each other, sum(m) (d v + d x / h)^2 / l, l the shortest rod; and the
// stretch of rods that give, E A / l d x.
double force_round_off(const Simulation& run);

// Values that follow from rod forces and are zero where these are [states x rods of the solved model]: with
// zeros in place of what is rounding alone.
MatrixXd without_round_off(const Simulation& run, const Diagnostics& diagnostics, MatrixXd values);

// Whether no rod has a force but of rounding.
bool only_round_off(const Simulation& run, const Diagnostics& diagnostics);

// Whether a column is a force, a stress, or a share of what a rod bears.
bool is_force(const Series& column);

// What a column of forces, torques or stresses may have of rounding alone between states, where steps are
// looked into: 1e-4 of its own largest value and, of forces [N], of the largest axial force.
double round_off_within_steps(const Series& force, const Diagnostics& diagnostics);

}  // namespace unfurl
