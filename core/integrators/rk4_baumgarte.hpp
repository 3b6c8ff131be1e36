// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/integrator.hpp"

namespace unfurl {

// Classical Runge-Kutta on equations whose constraint errors decay (Baumgarte 1972),
//
//     Phi'' + 2 alpha Phi' + alpha^2 Phi = 0
//
// with alpha = solver.baumgarte [1/s]. Exact motions are those of the unstabilised equations, so the order
// stays 4; errors of the constraints settle where the drift of a step and the decay balance. Stable for alpha
// h < 2.7. Where steps end on the constraints (StageAccelerations) nothing is left to decay.
Claims rk4_baumgarte_claims(const SolverOptions& options);
std::unique_ptr<Integrator> make_rk4_baumgarte(const System& system, const SolverOptions& options);

}  // namespace unfurl
