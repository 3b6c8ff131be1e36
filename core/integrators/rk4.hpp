#pragma once

#include <memory>

#include "core/integrators/integrator.hpp"

namespace unfurl {

// Classical Runge-Kutta of order 4 on the index-1 equations: what the paper compares with. Only the second
// derivative of the constraints is imposed, so positions drift off them like h^4.
Claims rk4_claims(const SolverOptions& options);
std::unique_ptr<Integrator> make_rk4(const System& system, const SolverOptions& options);

}  // namespace unfurl
