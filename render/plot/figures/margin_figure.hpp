// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/path/margin.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

// Drives stacked upwards, resistances downwards, by source over the path; below, the static margin in every
// pose and the dynamic one along the motion.
Figure margin_figure(const Margin& margin, const std::string& title);

}  // namespace unfurl
