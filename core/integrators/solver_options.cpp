// SPDX-License-Identifier: BSD-3-Clause
#include "core/integrators/solver_options.hpp"

#include "core/integrators/integrator.hpp"

namespace unfurl {

namespace {

std::vector<std::string_view> method_names() {
  std::vector<std::string_view> names;
  for (const auto& method : methods()) names.push_back(method.name);
  return names;
}

}  // namespace

const std::vector<ParamSpec>& solver_params() {
  static const SolverOptions fallback;
  static const std::vector<ParamSpec> params = {
      choice_param(
          "model", fallback.model, {"auto", "full", "path", "sector"},
          "every node by the method (full), one number along the path of a structure that can move "
          "in one way only (path), one sector of a ring whose sectors are alike (sector), or the path, "
          "else a sector, where they apply (auto; default of sweep, solve, margin)"),
      choice_param("method", fallback.method, method_names(), "integrator; `unfurl list methods`"),
      only_with("method", {"dvm"},
                integer_param("stages", fallback.stages, 2, 8, "s, the interpolation nodes on a step (dvm)")),
      only_with("method", {"dvm"},
                choice_param("nodes", fallback.nodes, {"lobatto", "equidistant", "chebyshev"},
                             "where the interpolation nodes lie on a step (dvm)")),
      only_with("method", {"dvm"},
                choice_param("constraints_at", fallback.constraints_at, {"nodes", "ends"},
                             "constraints hold at every interpolation node, or at step ends only (dvm)")),
      only_with(
          "method", {"rk4_baumgarte"},
          positive_param("baumgarte", "1/s", fallback.baumgarte,
                         "rate at which constraint errors decay; stable below 2.7 / step (rk4_baumgarte)")),
      only_with("method", {"generalized_alpha"},
                real_param("rho_inf", "", fallback.rho_inf, 0.0, 1.0,
                           "what is left of the fastest oscillations after a step; 1 damps nothing "
                           "(generalized_alpha)")),
      positive_param("step", "s", fallback.step, "time step h"),
      boolean_param("adaptive", fallback.adaptive,
                    "steps follow the motion, time-symmetrically and none larger than `step`; a symplectic "
                    "method is then symmetric only"),
      only_with(
          "adaptive", {"true"},
          positive_param("turn", "rad", fallback.turn,
                         "with `adaptive`: about how far a rod may turn, or velocities change, in a step")),
      real_param("tolerance", "m", fallback.tolerance, 0.0, 1e6,
                 "of node positions; stages and step are picked for it; 0: they are as given"),
      positive_param("end_time", "s", fallback.end_time,
                     "the run ends here at the latest; where the structure can deploy 60 by default"),
      choice_param("at_deployed", fallback.at_deployed, {"stop", "pass", "latch"},
                   "when fully deployed: the run stops, the motion passes through, or the structure locks"),
      boolean_param(
          "eliminate_linear", fallback.eliminate_linear,
          "solve in coordinates that fulfil the linear constraints, where that pays; changes no result"),
      boolean_param(
          "sparse", fallback.sparse,
          "sparse factorisations; false: dense ones, to see what sparsity is worth; changes no result"),
  };
  return params;
}

SolverOptions solver_options(const ParamSet& values) {
  SolverOptions options;
  options.model = values.text("model");
  options.method = values.text("method");
  options.stages = static_cast<int>(values.integer("stages"));
  options.nodes = values.text("nodes");
  options.constraints_at = values.text("constraints_at");
  options.baumgarte = values.real("baumgarte");
  options.rho_inf = values.real("rho_inf");
  options.step = values.real("step");
  options.adaptive = values.boolean("adaptive");
  options.turn = values.real("turn");
  options.tolerance = values.real("tolerance");
  options.end_time = values.real("end_time");
  options.at_deployed = values.text("at_deployed");
  options.sparse = values.boolean("sparse");
  options.eliminate_linear = values.boolean("eliminate_linear");
  return options;
}

ParamSet solver_values(const SolverOptions& solver) {
  ParamSet values;
  values.set("model", solver.model);
  values.set("method", solver.method);
  values.set("stages", static_cast<long>(solver.stages));
  values.set("nodes", solver.nodes);
  values.set("constraints_at", solver.constraints_at);
  values.set("baumgarte", solver.baumgarte);
  values.set("rho_inf", solver.rho_inf);
  values.set("step", solver.step);
  values.set("adaptive", solver.adaptive);
  values.set("turn", solver.turn);
  values.set("tolerance", solver.tolerance);
  values.set("end_time", solver.end_time);
  values.set("at_deployed", solver.at_deployed);
  values.set("sparse", solver.sparse);
  values.set("eliminate_linear", solver.eliminate_linear);
  return values;
}

}  // namespace unfurl
