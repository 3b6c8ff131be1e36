// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/run_words.hpp"

#include "core/forces/pin_loads.hpp"

namespace unfurl {

std::string cure(const Model& model, const State& state, bool latched, bool in_a_step) {
  for (const Constraint& drive : model.structure.constraints)
    if (latched && drive.target.derivative(1, state.t) != 0)
      return "; the latch holds what " + drive.name +
             " drives on: solver.at_deployed = \"stop\" ends the run there, a force of kind = \"motor\" "
             "stalls";
  const std::string step =
      in_a_step ? "; a smaller solver.step, or solver.adaptive = true, may get through" : "";
  if (!PinLoads::any(model.structure)) return step;
  VectorXd q(model.system.coordinates());
  model.system.expand(state.z, q);
  const auto locked = PinLoads::self_locking(model.structure, model.system.node_mass(), state.t, q.data());
  return locked.friction.empty() ? step : "; pin_friction of " + locked.friction + " " + locked.problem;
}

}  // namespace unfurl
