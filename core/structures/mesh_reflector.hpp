// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

// A deployable reflector: a hoop (cable_ring or hoop), a front and a rear net between the corners of its
// posts, each other's mirror image about z = 0, and tension ties between them.
//
//   Net: triangles, in `net_rings` rings around the centre, r n nodes in ring r; the outermost ring is the
//   edge, which ends at the n corners. Members have one force density q, those of the edge more.
//   Form finding in the deployed pose: sum_j q_ij (x_i - x_j) = 0 across the axis places the nodes in plan;
//   their heights are those of the paraboloid z = (x^2 + y^2) / (4 f) + c through the corners. What is left,
//
//     f_i = sum_j q_ij (z_j - z_i) = 1/(4 f) sum_j q_ij |p_j - p_i|^2 > 0     (p: in plan)
//
//   is the force of the tie there, a tension for any net. (Equal densities in an even grid give equal ones.)
//   The edge has no ties and hangs between its corners and the ring inside, above the paraboloid.
//   A member of the length l is cut to l_0 = l / (1 + q l / E A); it pulls by the smoothed law of a cable.
//   Folded, nodes are where no member is longer than l_0: from the facets between centre and corners, pulled
//   together member by member.
//
// Nodes: those of the hoop, Fr.i and Rr.i of the nets. The column surface_rms_m is what the front net is off
// its paraboloid, its edge aside.
const std::vector<ParamSpec>& mesh_reflector_params();
Structure build_mesh_reflector(const ParamSet& params);

}  // namespace unfurl
