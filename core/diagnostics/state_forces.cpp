// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/state_forces.hpp"

#include <limits>
#include <vector>

namespace unfurl {

VectorXd StateForces::multipliers(std::size_t i, VectorXd& node_acceleration) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const System& system = trajectory_.model(i).system;
  const bool limit = trajectory_.report(i).singular_event;
  if (!limit && (i < first_ || i >= behind_last_)) solve_from(i);
  const bool known = !limit && lanes_->ok(i - first_);
  node_acceleration.resize(system.coordinates());
  system.expand_rate(
      known ? lanes_->acceleration(i - first_) : VectorXd::Constant(system.solved_coordinates(), nan),
      node_acceleration);
  const VectorXd& held = trajectory_.state(i).lambda;
  if (limit) return held;
  return known ? lanes_->lambda(i - first_) : VectorXd::Constant(system.constraints(), nan);
}

void StateForces::solve_from(std::size_t i) {
  if (model_ != &trajectory_.model(i)) {
    model_ = &trajectory_.model(i);
    lanes_.emplace(model_->system);
  }
  std::vector<const State*> states;
  first_ = behind_last_ = i;
  while (states.size() < SaddleLanes::lanes && behind_last_ < trajectory_.size() &&
         &trajectory_.model(behind_last_) == model_ && !trajectory_.report(behind_last_).singular_event)
    states.push_back(&trajectory_.state(behind_last_++));
  lanes_->evaluate(states);
}

}  // namespace unfurl
