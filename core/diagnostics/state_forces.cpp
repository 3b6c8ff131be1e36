// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/state_forces.hpp"

#include <limits>
#include <utility>
#include <vector>

namespace unfurl {

SolvedPoint StateForces::at(std::size_t i) {
  if (ahead_ && i < ahead_->size()) return (*ahead_)[i];
  if (trajectory_.report(i).singular_event) return {};
  if (i < first_ || i >= behind_last_) solve_from(i);
  const std::size_t k = i - first_;
  if (!lanes_->ok(k)) return {};
  return {lanes_->acceleration(k), lanes_->lambda(k), true};
}

VectorXd StateForces::multipliers(std::size_t i, VectorXd& node_acceleration) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const System& system = trajectory_.model(i).system;
  SolvedPoint here = at(i);
  node_acceleration.resize(system.coordinates());
  system.expand_rate(here.known ? here.acceleration : VectorXd::Constant(system.solved_coordinates(), nan),
                     node_acceleration);
  if (trajectory_.report(i).singular_event) return trajectory_.state(i).lambda;
  return here.known ? std::move(here.lambda) : VectorXd::Constant(system.constraints(), nan);
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
