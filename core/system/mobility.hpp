// SPDX-License-Identifier: BSD-3-Clause
// How freely a structure can move: the rank of its constraints and the rows that add nothing to it.
#pragma once

#include <string>
#include <vector>

#include "core/system/system.hpp"

namespace unfurl {

// What is left of a unit row after taking out all earlier ones counts as zero below this. Entries carry
// round-off of 1e-16 and the chains of operations behind them amplify it to 1e-13 at most; what a real
// structure leaves is its distance from a singular pose, 3e-3 for the folded ring of six units and 1e-7 for
// one of a thousand.
inline constexpr double dependent_row = 1e-11;
// What rounding the coordinates leaves of it where the structure stands far from the origin, give or take:
// the largest coordinate by the longest side of the box that holds the nodes.
double rounding_of_rows(const System& system, const ConstVec& q);

struct Mobility {
  Index coordinates = 0;               // 3 n
  Index constraints = 0;               // rows of G, eliminated linear ones included, implied ones not
  Index rank = 0;                      // of G
  std::vector<std::string> redundant;  // rows that follow from the rows before them, in order
  std::vector<int> redundant_rows;     // the same by number
  Index degrees_of_freedom = 0;        // coordinates - rank, but for the integrals of controllers
  Index count = 0;          // the same with constraints for rank: Maxwell's count, blind to redundant rows
  Index rigid_motions = 0;  // of the degrees of freedom: motions of the whole as one rigid body
};

// The Jacobian of all constraints at the pose q [3 n], every row scaled to length 1; rows of zeros stay.
SparseRows unit_rows(const System& system, const ConstVec& q);
// The rows that are counted: all that are not implied by others of their own constraint.
std::vector<int> counted_rows(const System& system, const ConstVec& q);
// These rows alone, in ascending order.
SparseRows picked_rows(const SparseRows& A, const std::vector<int>& rows);

// At the pose q [3 n] of the solved nodes.
Mobility analyse_mobility(const System& system, const ConstVec& q);
// Of G, whose rank that is, with rows of unit length: how far the pose is from one in which more can move.
// NaN: too large a structure.
double smallest_singular_value(const System& system, const ConstVec& q, Index rank);

// How many of the six rigid-body motions violate no constraint, of a structure that is not on one line: six
// less the rank of G R, R = [translations, rotations]. Numbers of drives are nowhere in space and follow as
// they must: with their coordinates E beside R, what [R, E] has and E alone does not.
Index rigid_motions(const SparseRows& G, const ConstVec& q, const std::vector<int>& ghosts);

}  // namespace unfurl
