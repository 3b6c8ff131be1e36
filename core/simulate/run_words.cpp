// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/run_words.hpp"

#include "core/forces/pin_loads.hpp"
#include "core/system/consistency.hpp"

namespace unfurl {

std::string cure(const Model& model, const State& state, bool latched, double h) {
  for (const Constraint& drive : model.structure.constraints)
    if (latched && drive.target.derivative(1, state.t) != 0)
      return "; the latch holds what " + drive.name +
             " drives on: solver.at_deployed = \"stop\" ends the run there, a force of kind = \"motor\" "
             "stalls";
  VectorXd q(model.system.coordinates());
  model.system.expand(state.z, q);
  constexpr double soon = 1e-3;  // of the step: what begins there has a rate, and the pose is still right
  if (h > 0)
    if (const std::string driven = driven_against(model.system.at(state), state.t + soon * h, q);
        !driven.empty())
      return "; no motion follows what is driven there (" + driven +
             "): they move one another or what is held; take one away, or let rods give "
             "(structure.rod_model)";
  std::string step = h > 0 ? "; a smaller solver.step, or solver.adaptive = true, may get through" : "";
  if (!PinLoads::any(model.structure)) return step;
  const auto locked = PinLoads::self_locking(model.structure, model.system.node_mass(), state.t, q.data());
  return locked.friction.empty() ? step : "; pin_friction of " + locked.friction + " " + locked.problem;
}

}  // namespace unfurl
