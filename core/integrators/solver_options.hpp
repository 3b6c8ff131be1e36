// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/text/param_spec.hpp"

namespace unfurl {

// The [solver] table of a scene, checked.
struct SolverOptions {
  std::string model = "full";  // full | path | auto: what is solved for (study/tolerance.hpp)
  std::string method = "dvm";
  int stages = 3;                        // s, the interpolation nodes on a step
  std::string nodes = "lobatto";         // lobatto | equidistant | chebyshev
  std::string constraints_at = "nodes";  // nodes | ends
  double baumgarte = 20.0;               // rate at which rk4_baumgarte lets constraint errors decay [1/s]
  double rho_inf = 0.9;                  // what generalized_alpha leaves of the fastest oscillations, 0..1
  double step = 0.01;                    // h [s]
  bool adaptive = false;                 // steps follow the motion, none larger than h
  double turn = 0.1;                     // with `adaptive`: turn of a rod that a step may bring [rad]
  double tolerance = 0;                  // of node positions; 0: stages and step are as given [m]
  double end_time = 1.0;                 // [s]
  std::string at_deployed = "stop";      // stop | pass | latch
  bool sparse = true;                    // false: dense factorisations, for comparison
  bool eliminate_linear = true;          // solve in coordinates that fulfil the linear constraints exactly
};

const std::vector<ParamSpec>& solver_params();         // one row per key of [solver]
ParamSet solver_values(const SolverOptions& options);  // and back
SolverOptions solver_options(const ParamSet& values);  // values: checked against solver_params()

}  // namespace unfurl
