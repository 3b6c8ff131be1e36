// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl {

// The structure in the pose q [3 n], its rods rigid at the lengths that they have there: the mechanism whose
// motions an elastic structure has beside its waves. Rods keep their compliance, so that forces are shared as
// before.
Structure rigid_twin(const Structure& structure, const ConstVec& q);

}  // namespace unfurl
