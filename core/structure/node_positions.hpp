// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl {

// Where the nodes are as the structure is given, one after the other: x_0, y_0, z_0, x_1, ... [m]
VectorXd node_positions(const Structure& structure);

}  // namespace unfurl
