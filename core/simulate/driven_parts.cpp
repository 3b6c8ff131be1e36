// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/driven_parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/math/coupled_columns.hpp"
#include "core/simulate/driven_deployed.hpp"
#include "core/simulate/free_motion.hpp"
#include "core/simulate/initial_state.hpp"
#include "core/simulate/latch.hpp"

namespace unfurl {

State in_last_model(const Trajectory& trajectory, std::size_t i) {
  const System &from = trajectory.model(i).system, &to = trajectory.last_model().system;
  if (&from == &to) return trajectory.state(i);
  State out = in_coordinates(from, trajectory.state(i), to);
  out.lambda.setZero(to.constraints());
  project(to, out);
  return out;
}

namespace {

constexpr double far_from_pose = 1e-2;  // of what remains

// The last state of the run that is not next to the pose, or its first.
State far_state(const Trajectory& trajectory) {
  const Deployment& deployment = trajectory.last_model().structure.deployment;
  std::size_t i = trajectory.size() - 1;
  const auto near = [&](const State& state) {
    return std::abs(deployment.remaining(trajectory.node_positions(i), state.angles)) <= far_from_pose;
  };
  while (i > 0 && near(trajectory.state(i))) --i;
  return in_last_model(trajectory, i);
}

}  // namespace

LeftRate::LeftRate(const Trajectory& trajectory) : model_(trajectory.last_model()) {
  const State state = far_state(trajectory);
  q_.resize(model_.system.coordinates());
  v_.resize(q_.size());
  model_.system.expand(state.z, q_);
  any_.resize(model_.system.solved_coordinates());
  for (Index k = 0; k < any_.size(); ++k) any_[k] = std::sin(1.0 + static_cast<double>(k));
  all_ = std::abs(of(any_));
}
double LeftRate::of(const VectorXd& w) {
  const Deployment& deployment = model_.structure.deployment;
  model_.system.expand_rate(w, v_);
  return deployment.folds() ? deployment.fold_rate(q_, v_) : deployment.remaining_rate(q_, v_);
}
bool LeftRate::takes(const VectorXd& those) {
  return std::abs(of(those.cwiseProduct(any_))) > 1e-9 * all_;
}

DrivenParts driven_parts(const Trajectory& trajectory) {
  const System& system = trajectory.last_model().system;
  const Index n = system.solved_coordinates();
  DrivenParts out{free_coordinates(system, far_state(trajectory)), true};
  LeftRate left(trajectory);
  VectorXd those = VectorXd::Zero(n);
  those(out.free).setOnes();
  if (!left.takes(those)) return out;
  CoupledColumns columns(n);
  columns.join_rows_of(system.jacobian_pattern());
  std::map<Index, std::vector<Index>> sets;
  for (Index i = 0; i < n; ++i) sets[columns.set_of(i)].push_back(i);
  out = {{}, false};
  for (const auto& [first, set] : sets) {
    those.setZero();
    those(set).setOnes();
    if (!left.takes(those)) std::ranges::copy(set, std::back_inserter(out.free));
  }
  std::ranges::sort(out.free);
  return out;
}

bool drives_lead_to_deployed(const Trajectory& trajectory) {
  constexpr double none = 1e-6;  // of a rate
  const Model& model = trajectory.last_model();
  const Deployment& deployment = model.structure.deployment;
  if (model.system.drives().empty() || deployment.empty()) return false;
  const State state = far_state(trajectory);
  VectorXd q(model.system.coordinates()), free(q.size());
  model.system.expand(state.z, q);
  for (Index k = 0; k < free.size(); ++k) free[k] = std::sin(1.0 + static_cast<double>(k));  // any motion
  const System near = model.system.at(state);
  const auto rate = [&](const VectorXd& v) {
    return deployment.folds() ? deployment.fold_rate(q, v) : deployment.remaining_rate(q, v);
  };
  const auto fitted = [&](const VectorXd& v) {
    VectorXd out(q.size());
    near.expand_rate(fitted_rates(near, state.t, q, v), out);
    return rate(out);
  };
  return std::abs(fitted(free) - fitted(VectorXd::Zero(q.size()))) <= none * std::abs(rate(free));
}

}  // namespace unfurl
