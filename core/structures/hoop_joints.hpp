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

}  // namespace unfurl
