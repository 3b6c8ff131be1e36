// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/diagnostics/vibration.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

// The first modes of elastic rods, or as many of the mechanism's own as there is room for, each over its
// pose. positions: of the whole structure there [3 N].
Figure mode_shapes_figure(const Structure& structure, const VectorXd& positions, const Vibration& vibration,
                          const std::string& title);

}  // namespace unfurl
