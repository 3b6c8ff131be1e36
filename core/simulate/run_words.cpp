// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/run_words.hpp"

#include "core/forces/pin_loads.hpp"
#include "core/simulate/turning_back.hpp"
#include "core/system/blocked_motion.hpp"
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
  if (h > 0) {
    const System system = model.system.at(state);
    if (const std::string beyond = beyond_reach(system, state.t, h, q); !beyond.empty()) return "; " + beyond;
    if (const std::string end = at_its_end(model.structure, system, state, h); !end.empty())
      return ": " + end;
    if (const std::string rods = held_at_second_order(system, q); !rods.empty())
      return "; " + rods +
             " hold each other in this pose, and what looks free there is not (as rods in line are not): "
             "draw them a little slack, or let rods give (structure.rod_model)";
    VectorXd v(model.system.coordinates());
    system.expand_rate(state.w, v);
    if (of_no_branch(system, q, v))
      return "; the velocities lead into none of the motions that go on from this pose, where constraints "
             "depend on each other: give those of one of them, or none";
    if (model.structure.kind == "custom" && misfit_of_rows(system, q) > 0)
      return "; constraints depend on each other, and the positions fit them to fewer digits than a step "
             "needs: give the positions all 16 digits, or solver.model = \"path\"";
  }
  std::string step = h > 0 ? "; a smaller solver.step, or solver.adaptive = true, may get through" : "";
  if (!PinLoads::any(model.structure)) return step;
  const auto locked = PinLoads::self_locking(model.structure, model.system.node_mass(), state.t, q.data());
  return locked.friction.empty() ? step : "; pin_friction of " + locked.friction + " " + locked.problem;
}

}  // namespace unfurl
