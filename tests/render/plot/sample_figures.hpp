// SPDX-License-Identifier: BSD-3-Clause
// Figures from made-up data, ordinary and hostile, for every test that looks at what is painted.
#pragma once

#include <vector>

#include "render/plot/figure.hpp"

namespace unfurl {

std::vector<Figure> sample_figures();

}  // namespace unfurl
