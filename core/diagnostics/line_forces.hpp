// SPDX-License-Identifier: BSD-3-Clause
// Axial forces of what lies between nodes and is no rod.
#pragma once

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// Tension positive [N]; at a state at which it is not known NaN. Of a cable whose law has let it go slack, 0.
struct LineForces {
  MatrixXd lines;    // [states x Structure::lines]
  MatrixXd springs;  // [states x Structure::forces]; NaN of what is no spring between two nodes
};
LineForces line_forces(const Simulation& run, const Diagnostics& diagnostics);

}  // namespace unfurl
