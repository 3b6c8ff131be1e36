// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/rk4_baumgarte.hpp"

#include "core/integrators/rk4.hpp"

namespace unfurl {

Claims rk4_baumgarte_claims(const SolverOptions&) {
  return {.order = 4};
}

std::unique_ptr<Integrator> make_rk4_baumgarte(const System& system, const SolverOptions& options) {
  return std::make_unique<RungeKutta4>(system, options.baumgarte);
}

}  // namespace unfurl
