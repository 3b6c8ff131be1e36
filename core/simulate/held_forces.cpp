// SPDX-License-Identifier: BSD-3-Clause
// Of one-sided holds: their forces, and how far what sticks is from its limit.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include "core/constraints/measure_rows.hpp"
#include "core/simulate/friction_hold.hpp"
#include "core/simulate/one_sided.hpp"
#include "core/simulate/push_responses.hpp"

namespace unfurl {
namespace {

constexpr double force_zero = 1e-10;     // of the largest multiplier
constexpr double rounded_force = 1e-13;  // of what acts: may be left of a force that is the only one

}  // namespace

void OneSided::follow(const Model& model, const State& state) {
  if (!index1_) {
    followed_.emplace(model.system);
    index1_ = std::make_unique<Index1>(*followed_);
    parts_.emplace(model.system);
    VectorXd q(model.system.coordinates()), v(q.size());
    model.system.expand(state.z, q);
    model.system.expand_rate(state.w, v);
    parts_->join_by_forces(model.system, state.t, q, v);
  }
  followed_->follow(state);
  acceleration_.resize(state.z.size());
  lambda_ = state.lambda;
}

void OneSided::measure_held(const Model& model, const State& state, Probe& probe) {
  follow(model, state);
  State with_forces = state;
  if (index1_->evaluate(state, acceleration_, lambda_)) with_forces.lambda = lambda_;
  const VectorXd zero = (force_zero * parts_->largest_of_rows(with_forces.lambda))
                            .cwiseMax(rounded_force * parts_->largest(index1_->applied_force(state).data()))
                            .cwiseMax(std::numeric_limits<double>::min());
  VectorXd zeros = VectorXd::Zero(std::ssize(active_));
  weigh(model, state);
  const std::set<std::size_t> held = this->held();
  for (const std::size_t i : held) {
    const auto row = static_cast<Index>(i);
    const double push = stops_.push(i, model, held, with_forces);
    zeros[row] = zero[parts_->of_row(stops_.held_row(i, model, held))];
    probe.margins[row] = push / zeros[row], probe.forces[row] = std::abs(push);
    held_force_[row] = push * (measure(i).is_angle() ? row_arm(model.structure, stops_[i].measure) : 1.0);
  }
  // What sticks lies before the stops that are held, in its order.
  auto constraint = static_cast<int>(std::ssize(model.structure.constraints) - std::ssize(held));
  for (std::size_t i = first_motor(); i-- > first_friction();)
    if (active_[i]) {
      const int row = model.system.constraint_row(--constraint);
      held_force_[static_cast<Index>(i)] = -with_forces.lambda[row] * friction(i).row;
      zeros[static_cast<Index>(i)] = zero[parts_->of_row(row)];
    }
  measure_sticking(zeros, probe);
}

// A gap that its force lets go opens with the cube of time, which a step of second order follows with either
// sign: it is no contact where no more is passed than what pulls away makes in that time, while the gap has
// about the rate that comes of it. What swings back within the step is slower by then.
bool OneSided::leaves(std::size_t i, const Model& model, const State& state, double passed,
                      double rate) const {
  const double since = state.t - let_go_[static_cast<Index>(i)];
  if (!(since > 0)) return false;
  const System system = model.system.at(state);
  PushResponses responses(system, state);
  if (responses.ok()) responses.add(measure(i), sign(i), near(i, state), limit_motion(i, state.t));
  const VectorXd away = responses.accelerations(model.structure, state).value;
  return away.size() == 1 && passed < away[0] * since * since && 4 * rate > away[0] * since;
}

// Of frictions that stick: those that are held, by stops too, and those that rest by them, as stops may.
void OneSided::measure_sticking(const VectorXd& zeros, Probe& probe) {
  std::vector<Index> held, resting;
  VectorXd tau = VectorXd::Constant(held_force_.size(), std::numeric_limits<double>::infinity());
  for (Index i = 0; i < tau.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (is_friction(k)) tau[i] = holding(k);
    if ((is_stop(k) || is_friction(k)) && active_[k])
      held.push_back(i);
    else if (shares_.rows() > 0 && (is_friction(k) ? slip(k) == 0 : is_stop(k) && probe.margins[i] <= 1))
      resting.push_back(i);
  }
  const MatrixXd shares = resting.empty() ? MatrixXd(0, std::ssize(held)) : MatrixXd(shares_(resting, held));
  for (const FrictionHold& hold : friction_holds(shares, held_force_(held), tau(held), tau(resting)))
    for (const Index k : hold.held) {
      const Index i = held[static_cast<std::size_t>(k)];
      if (!is_friction(static_cast<std::size_t>(i))) continue;
      const double arm = friction(static_cast<std::size_t>(i)).row;
      probe.margins[i] = (hold.capacity - hold.load) / std::max(zeros[i] * arm, force_zero * hold.capacity);
    }
}

}  // namespace unfurl
