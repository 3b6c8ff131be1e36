// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/integrators/integrator.hpp"

namespace unfurl {

// Classical Runge-Kutta whose steps end with a projection of positions, then velocities, on the constraints
// in the mass metric (Hairer, Lubich & Wanner, Geometric Numerical Integration, IV.4 and VII.2). The
// projection moves a step by no more than its own error: the order stays 4.
Claims rk4_projected_claims(const SolverOptions& options);
std::unique_ptr<Integrator> make_rk4_projected(const System& system, const SolverOptions& options);

}  // namespace unfurl
