// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/constraints/constraint.hpp"

namespace unfurl {

// Linear constraints: every row is Phi = sum_i c_i q_i - b with constant coefficients, G = c, no curvature. A
// row's coefficients are directions, so that it is in metres.
//
//   plane     n . x = value                                    one row;  vectors = {unit normal n}
//   line      the two directions across `vectors[0]` are held  two rows; the line passes through the node at
//   t = 0 fixed     the node stays where it is at t = 0              three rows relation  sum_i vectors[i] .
//   x_{nodes[i]} = value          one row: mirror, equality, any affine relation; divided by
//             its longest vector, so that errors are metres of a node whatever the size of the coefficients

// The length that an error is compared with where a row has none of its own: the mean rod length, without
// rods how far a node is from the first at most, and a metre where all are at one place.
double reference_length(const Structure& structure);

std::unique_ptr<ConstraintBlock> plane_block(const Structure& structure);
std::unique_ptr<ConstraintBlock> line_block(const Structure& structure);
std::unique_ptr<ConstraintBlock> fixed_block(const Structure& structure);
std::unique_ptr<ConstraintBlock> relation_block(const Structure& structure);

// The picked rows (ascending, counted over all blocks) of linear blocks, as a block of their own.
std::unique_ptr<ConstraintBlock> linear_rows_of(std::span<const ConstraintBlock* const> blocks,
                                                std::span<const int> picked, Index coordinates);

}  // namespace unfurl
