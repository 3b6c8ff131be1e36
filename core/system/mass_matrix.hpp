// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/math/types.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

// Mass matrix of the node coordinates [3n x 3n, kg]. A uniform rigid rod ab of mass m has the kinetic energy
//
//     T_ab = (m / 6) (|va|^2 + va.vb + |vb|^2)                              (paper eq. 6)
//
// exactly, hence m/3 on the diagonal and m/6 off it; a lumped rod has m/2 at each end. Node masses are added.
SparseRows node_mass_matrix(const Structure& structure);

}  // namespace unfurl
