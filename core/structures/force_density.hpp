// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

// A member of a net with its force per length q [N/m].
struct NetMember {
  int a = 0, b = 0;
  double density = 0.0;
};

// Form finding by force densities (Schek 1974): sum_j q_ij (x_i - x_j) = f_i for every node that is not
// fixed, one symmetric linear system for all three coordinates. `positions`: of the fixed nodes; the others
// are filled. loads: one for each node [N]. Throws StructureError("", why) where the net leaves a node
// without hold.
void find_form(const std::vector<NetMember>& members, const std::vector<bool>& fixed,
               const std::vector<Vec3>& loads, std::vector<Vec3>& positions);

}  // namespace unfurl
