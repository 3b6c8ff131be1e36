// SPDX-License-Identifier: BSD-3-Clause
// The functions behind the table of figures; figures.cpp says what each shows.
#pragma once

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/simulation.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

Figure deployment_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure constraint_error_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure energy_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure rod_forces_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure rod_strength_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure drives_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure poisson_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure phase_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure steps_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure jacobian_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure self_stress_figure(const Simulation& run, const Diagnostics& diagnostics);
Figure poses_figure(const Simulation& run, const Diagnostics& diagnostics);

}  // namespace unfurl
