// SPDX-License-Identifier: BSD-3-Clause
// Elastic rods whose length without force is not the distance of their nodes.
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl {

// Moves the nodes to where the rods that give are in balance among themselves, without loads, gravity and
// springs, while rigid rods and constraints hold: what a person does who joins rods that do not quite fit.
// Where all lengths fit without force (solve_for_pose, fit_lengths.hpp), rods that were cut to bend straight
// as they are, that is all; else they go on from where they fit best with the mechanism held, straight but
// for rods that constraints of angles or of their inner nodes may bend. With r the forces of these rods and K
// their derivatives, Newton's steps
//
//     [ K + e M   G^T ] [ dz     ]   [  r   ]
//     [ G          0  ] [ lambda ] = [ -Phi ]
//
// where e M, small, keeps them short along what no rod resists: motions of the mechanism. Where self-stress
// drives these for ever, or farther than a few times what the lengths ask for in the linear theory, they are
// held instead, and the structure starts out of balance by that.
// A note of the largest force of self-stress is added; nothing happens where all lengths fit, and rods with a
// free_length of their own stay stretched. Throws StructureError that names the rod furthest off where a
// length is further off than fitted_share, or no balance is found near the given pose.
void assemble_elastic(Structure& structure, bool eliminate_linear);

}  // namespace unfurl
