// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/run_words.hpp"

#include "core/forces/pin_loads.hpp"

namespace unfurl {

std::string what_locks(const Model& model, const State& state, bool latched) {
  for (const Constraint& drive : model.structure.constraints)
    if (latched && drive.target.derivative(1, state.t) != 0)
      return "; the latch holds what " + drive.name +
             " drives on: solver.at_deployed = \"stop\" ends the run there, a force of kind = \"motor\" "
             "stalls";
  if (!PinLoads::any(model.structure)) return "";
  VectorXd q(model.system.coordinates());
  model.system.expand(state.z, q);
  const auto locked = PinLoads::self_locking(model.structure, model.system.node_mass(), state.t, q.data());
  return locked.friction.empty() ? "" : "; pin_friction of " + locked.friction + " " + locked.problem;
}

}  // namespace unfurl
