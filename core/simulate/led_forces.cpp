// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/led_forces.hpp"

#include "core/structure/time_edges.hpp"

namespace unfurl {

void feel_as_at(System& system, FreeMotion& free, Index1& index1, const State& at, VectorXd acceleration,
                std::vector<NearDeployed>& samples) {
  const std::vector<Index>& own = free.coordinates();
  VectorXd lambda = VectorXd::Zero(system.constraints());
  system.follow(at);
  const bool feels = !own.empty() && free.solve(at, acceleration, lambda);
  const VectorXd felt = feels ? free.felt(at, acceleration, lambda) : VectorXd(),
                 acts = index1.applied_force(at);
  std::vector<VectorXd> applied;
  VectorXd depends = VectorXd::Zero(acts.size());  // 1: what acts there has to do with what is free
  for (const NearDeployed& sample : samples) {
    State mixed = sample.state;
    system.follow(mixed);
    mixed.t = before_jump(at.t);
    applied.push_back(index1.applied_force(mixed));
    mixed.z(own) = at.z(own);
    mixed.w(own) = at.w(own);
    mixed.tension = at.tension;
    const VectorXd& other = index1.applied_force(mixed);
    depends = (other.array() == applied.back().array()).select(depends, 1.0);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    State& state = samples[i].state;
    system.follow(state);
    VectorXd change = VectorXd::Zero(acts.size());
    if (feels && index1.evaluate(state, acceleration, state.lambda)) {
      change = free.felt(state, acceleration, state.lambda) - felt;
      change += depends.cwiseProduct(acts - applied[i]);
      change(own) = (index1.applied_force(state) - applied[i])(own);  // as what is felt of it has it
    }
    index1.correct(state, {&state.lambda, 1}, applied[i] + change);
    if (feels) state.lambda(free.rows()) = lambda(free.rows());
    state.t = before_jump(at.t);
  }
}

}  // namespace unfurl
