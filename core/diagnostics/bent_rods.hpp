// SPDX-License-Identifier: BSD-3-Clause
// Rods that were cut into parts that bend (structures/segments.hpp), in small motions about a pose.
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl {

// At a joint of two parts with the unit vectors t_1, t_2 the energy (E I / 2 L) |kappa|^2
// (forces/bending.hpp) has the second derivatives
//
//     (E I / L) sum_k g_k g_k^T + what follows from the moment,   g_k = d(e_k . (t_2 - t_1))/dq
//
// with e_1, e_2 at right angles to each other and to t_1 + t_2, e_1 in the plane of the joint.
struct BentRods {
  BentRods(const Structure& structure, const VectorXd& q);
  bool any() const { return rows.rows() > 0; }

  MatrixXd rows;           // g_k [joints x 3n]
  VectorXd stiffness;      // E I / L of each row [N m]
  std::vector<char> bent;  // whether the joint of a row has a moment
  MatrixXd rigid;          // of unit length; each rod moves as one rigid body where all of them vanish
  Structure unbent;        // the structure less the joints that have none
};

}  // namespace unfurl
