// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/study/sweep.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

// Every measure over the swept parameters: curves over one axis of numbers (one curve per value of a short
// second axis), or a map with contour lines over two. None where the sweep has no axis of numbers or more
// than two axes.
std::vector<Figure> sweep_figures(const SweepPlan& plan, const Sweep& sweep, const std::string& scene);

}  // namespace unfurl
