// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/scene/scene.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {

// What to say of rods whose lengths no pose has: the key structure.length_error, where that alone takes them
// off the distances of nodes; else the error as it is.
StructureError of_made_lengths(const Scene& scene, const StructureError& error);

}  // namespace unfurl
