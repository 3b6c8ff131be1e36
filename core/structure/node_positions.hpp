// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/structure/structure.hpp"

namespace unfurl {

// Where the nodes are as the structure is given, one after the other: x_0, y_0, z_0, x_1, ... [m]
VectorXd node_positions(const Structure& structure);

// How many coordinates those of the nodes in space are: ghosts, which are nowhere, come behind them.
Index space_coordinates(const Structure& structure);

}  // namespace unfurl
