// SPDX-License-Identifier: BSD-3-Clause
// Figures of studies: speed against accuracy.
#pragma once

#include "core/study/study.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

// Position error against CPU time, and against the number of linear solves.
Figure work_precision_figure(const Study& study, const std::string& scene);
// Position error, constraint error and energy error against the step.
Figure convergence_figure(const Study& study, const std::string& scene);

}  // namespace unfurl
