// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/study/stress.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

// One atlas per extreme: a panel per setting, steps over the motion across, the extreme upwards, colours by
// verdict.
std::vector<Figure> atlas_figures(const StressPlan& plan, const Stress& stress, const std::string& scene);
// Energy error and constraint error over very many steps.
Figure long_run_figure(const Stress& stress, const std::string& scene);

}  // namespace unfurl
