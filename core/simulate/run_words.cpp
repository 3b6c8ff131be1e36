// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/run_words.hpp"

#include "core/forces/pin_loads.hpp"

namespace unfurl {

std::string what_locks(const Model& model, const State& state) {
  if (!PinLoads::any(model.structure)) return "";
  VectorXd q(model.system.coordinates());
  model.system.expand(state.z, q);
  const auto locked = PinLoads::self_locking(model.structure, model.system.node_mass(), state.t, q.data());
  return locked.friction.empty() ? "" : "; pin_friction of " + locked.friction + " " + locked.problem;
}

}  // namespace unfurl
