// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/solver_options.hpp"

#include "core/integrators/integrator.hpp"
#include "core/text/param_binding.hpp"

namespace unfurl {

namespace {

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const auto& method : methods()) names.push_back(method.name);
  return names;
}

using O = SolverOptions;

const ParamBinding<O>& keys() {
  static const ParamBinding<O> rows({
      {choice_param(
           "model", "", {"auto", "full", "path", "sector"},
           "every node by the method (full), one number along the path of a structure that can move "
           "in one way only (path), one sector of a ring whose sectors are alike (sector), or the path, "
           "else a sector, where they apply (auto; default of sweep, solve, margin)"),
       &O::model},
      {choice_param("method", "", method_names(), "integrator; `unfurl list methods`"), &O::method},
      {only_with("method", {"dvm"},
                 integer_param("stages", 0, 2, 8, "s, the interpolation nodes on a step (dvm)")),
       &O::stages},
      {only_with("method", {"dvm"},
                 choice_param("nodes", "", {"lobatto", "equidistant", "chebyshev"},
                              "where the interpolation nodes lie on a step (dvm)")),
       &O::nodes},
      {only_with("method", {"dvm"},
                 choice_param("constraints_at", "", {"nodes", "ends"},
                              "constraints hold at every interpolation node, or at step ends only (dvm)")),
       &O::constraints_at},
      {only_with(
           "method", {"rk4_baumgarte"},
           positive_param("baumgarte", "1/s", 0,
                          "rate at which constraint errors decay; stable below 2.7 / step (rk4_baumgarte)")),
       &O::baumgarte},
      {only_with(
           "method", {"generalized_alpha"},
           real_param("rho_inf", "", 0, 0.0, 1.0,
                      "what is left of the fastest oscillations after a step; 1 damps nothing, forces of "
                      "rods need 0.95 or less (generalized_alpha)")),
       &O::rho_inf},
      {positive_param("step", "s", 0, "time step h"), &O::step},
      {boolean_param("adaptive", false,
                     "steps follow the motion, time-symmetrically and none larger than `step`; a symplectic "
                     "method is then symmetric only"),
       &O::adaptive},
      {only_with("adaptive", {"true"},
                 positive_param(
                     "turn", "rad", 0,
                     "with `adaptive`: about how far a rod may turn, a swing on a spring or a sine go on, "
                     "or velocities change, in a step")),
       &O::turn},
      {real_param("tolerance", "m", 0, 0.0, 1e6,
                  "of node positions; stages and step are picked for it; 0: they are as given"),
       &O::tolerance},
      {positive_param("end_time", "s", 0,
                      "the run ends here at the latest; where the structure can deploy 60 by default"),
       &O::end_time},
      {choice_param("at_deployed", "", {"stop", "pass", "latch"},
                    "when fully deployed: the run stops, the motion passes through, or the structure locks"),
       &O::at_deployed},
      {boolean_param(
           "eliminate_linear", false,
           "solve in coordinates that fulfil the linear constraints, where that pays; changes no result"),
       &O::eliminate_linear},
      {boolean_param(
           "sparse", false,
           "sparse factorisations; false: dense ones, to see what sparsity is worth; changes no result"),
       &O::sparse},
  });
  return rows;
}

}  // namespace

const std::vector<ParamSpec>& solver_params() {
  return keys().specs();
}
SolverOptions solver_options(const ParamSet& values) {
  return keys().read(values);
}
ParamSet solver_values(const SolverOptions& options) {
  return keys().values(options);
}

}  // namespace unfurl
