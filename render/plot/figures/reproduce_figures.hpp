// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/study/reproduce.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

// Figure 2 of the paper: poses of the deployment.
Figure reproduced_poses_figure(const Reproduction& r);
// Figures 3 and 4: constraint error of both methods over time, h = 0.01 s and 0.005 s, on the same axes.
Figure reproduced_constraint_figure(const Reproduction& r);
// What they do not show: the error of the trajectory, over time and against the step.
Figure reproduced_trajectory_figure(const Reproduction& r);

}  // namespace unfurl
