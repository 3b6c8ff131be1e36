// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/led_forces.hpp"

namespace unfurl {

void feel_as_at(System& system, FreeMotion& free, Index1& index1, const State& at, VectorXd acceleration,
                std::vector<NearDeployed>& samples) {
  const std::vector<Index>& own = free.coordinates();
  if (own.empty()) return;
  VectorXd lambda = VectorXd::Zero(system.constraints());
  system.follow(at);
  if (!free.solve(at, acceleration, lambda)) return;
  const VectorXd felt = free.felt(at, acceleration, lambda), acts = index1.applied_force(at);
  std::vector<VectorXd> applied;
  VectorXd depends = VectorXd::Zero(acts.size());  // 1: what acts there has to do with what is free
  for (const NearDeployed& sample : samples) {
    State mixed = sample.state;
    system.follow(mixed);
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
    if (!index1.evaluate(state, acceleration, state.lambda)) continue;
    VectorXd change = free.felt(state, acceleration, state.lambda) - felt;
    change += depends.cwiseProduct(acts - applied[i]);
    change(own).setZero();
    index1.correct(state, {&state.lambda, 1}, applied[i] + change);
    state.lambda(free.rows()) = lambda(free.rows());
  }
}

}  // namespace unfurl
