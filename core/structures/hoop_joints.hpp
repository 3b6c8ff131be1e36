// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"
#include "core/structures/hoop_shape.hpp"

namespace unfurl {

// A hoop, closed or an open arc, that floats free in space and may move without symmetry. Its joints keep the
// posts parallel to each other, and every chord hinge in the plane of its face, which the two posts beside it
// span. With p posts and n units: 6 p + 6 n coordinates, 3 (p - 1) relations, 4 n + p rod lengths, 2 n planes
// of faces; 3 p + 2 degrees of freedom, 6 of them those of a rigid body.
Structure build_hoop_joints(const HoopShape& shape);

// How far a closed ring of joints whose units are all driven alike has left the even motion, which it would
// keep for ever but for round-off: the spread of its posts' heights and of its sides, over a chord rod's
// length. The even motion is unstable. Shapes P_k = exp(2 pi i j k / n) of the plan grow at rates omega_j of
// which the deployment's, j = 1, is the least, and shifts of the hinges along their chords grow faster still:
// in six units as exp(4.3 t) against exp(1.05 t), so that from 89.9999 deg on an ulp of the start has grown
// by 1e18, to the size of the motion, before the ring is open. No solver can tell from such a start when it
// deploys: another representable pose beside it deploys otherwise.
bool driven_evenly(const Structure& structure);  // is it such a ring?
double unevenness(const Structure& structure, const ConstVec& q);

}  // namespace unfurl
