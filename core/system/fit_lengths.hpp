// SPDX-License-Identifier: BSD-3-Clause
// Rods whose given length is not quite the distance of their nodes.
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl {

// The most that a given length may differ from the distance of its nodes, as a share of it.
inline constexpr double fitted_share = 0.01;

// Are the nodes as far apart as all given lengths of rods say, but of those that start stretched?
bool lengths_fit(const Structure& structure);

class System;

// Newton's method on Phi = 0 at t = 0, each step the shortest in the mass metric. True where it is reached to
// round-off; q [3 n]: from there, and what was reached.
bool solve_for_pose(const System& system, VectorXd& q);

// Moves the nodes, in the mass metric, to where rods have their given lengths and all other constraints hold:
// Newton's method on Phi = 0. A note of how far is added to `structure`; nothing happens where all lengths
// fit. Throws StructureError that names rod, given length, distance and cure where a length is further off
// than fitted_share, or no pose near the given one has these lengths.
void fit_lengths(Structure& structure, bool eliminate_linear);

// Of the structure's notes the one that says how far nodes were moved to fit lengths, rigid or elastic;
// empty: none were.
std::string note_of_moved_nodes(const Structure& structure);

// The same with the nodes within rods that were cut to bend (structures/segments.hpp) in proportion on the
// line between their ends: what moves these leaves such a rod straight, and without a moment. all: also rods
// that constraints of angles or of their inner nodes may bend.
Structure kept_straight(const Structure& structure, bool all);

}  // namespace unfurl
