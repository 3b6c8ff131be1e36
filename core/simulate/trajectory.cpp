// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/trajectory.hpp"

#include <algorithm>

namespace unfurl {

Trajectory::Trajectory(std::shared_ptr<const Model> model, const SolverOptions& options)
    : models_{{0, std::move(model)}}, dense_(std::make_shared<DenseOutput>(options)) {}

void Trajectory::change_model(std::shared_ptr<const Model> model) {
  while (models_.size() > 1 && models_.back().first >= size()) models_.pop_back();  // without states
  models_.push_back({size(), std::move(model)});
}

const Trajectory::Part& Trajectory::part_of(std::size_t i) const {
  const auto behind = std::upper_bound(models_.begin() + 1, models_.end(), i,
                                       [](std::size_t state, const Part& p) { return state < p.first; });
  return *(behind - 1);
}

const Model& Trajectory::model(std::size_t i) const {
  return *part_of(i).model;
}

void Trajectory::append(State state, StepReport report) {
  states_.push_back(std::move(state));
  reports_.push_back(report);
}

void Trajectory::append(Trajectory&& next) {
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (const Part& p = next.part_of(i); p.model != models_.back().model) change_model(p.model);
    append(std::move(next.states_[i]), next.reports_[i]);
  }
  next.states_.clear();
  next.reports_.clear();
}

void Trajectory::pop_back() {
  states_.pop_back();
  reports_.pop_back();
  if (stretch_.size() > states_.size()) stretch_.pop_back();
}

Trajectory Trajectory::part(std::size_t first, std::size_t last, const SolverOptions& options) const {
  Trajectory out(models_.front().model, options);
  for (std::size_t i = first; i < last; ++i) {
    if (const Part& p = part_of(i); p.model != out.models_.back().model) out.change_model(p.model);
    out.append(states_[i], reports_[i]);
  }
  return out;
}

VectorXd Trajectory::node_positions(std::size_t i) const {
  const System& system = model(i).system;
  VectorXd q(system.coordinates());
  system.expand(states_[i].z, q);
  return q;
}

VectorXd Trajectory::node_velocities(std::size_t i) const {
  const System& system = model(i).system;
  VectorXd v(system.coordinates());
  system.expand_rate(states_[i].w, v);
  return v;
}

void Trajectory::add_stretch(std::size_t i, VectorXd displacement) {
  stretch_.resize(size(), VectorXd::Zero(displacement.size()));
  stretch_[i] = std::move(displacement);
}

// A straight line between the states.
VectorXd Trajectory::stretch_at(double t) const {
  const std::size_t i = state_before(t);
  if (i + 1 >= stretch_.size() || t <= time(i)) return stretch_[std::min(i, stretch_.size() - 1)];
  const double u = (t - time(i)) / (time(i + 1) - time(i));
  return (1 - u) * stretch_[i] + u * stretch_[i + 1];
}

VectorXd Trajectory::positions(std::size_t i) const {
  VectorXd q = node_positions(i);
  if (const VectorXd* u = stretch(i)) q += *u;
  return whole_positions(structure(), q);
}
VectorXd Trajectory::velocities(std::size_t i) const {
  return whole_velocities(structure(), node_velocities(i));
}

std::size_t Trajectory::state_before(double t) const {
  const auto after = std::upper_bound(states_.begin(), states_.end(), t,
                                      [](double value, const State& s) { return value < s.t; });
  return after == states_.begin() ? 0 : static_cast<std::size_t>(after - states_.begin()) - 1;
}

State Trajectory::state_at(double t) const {
  const std::size_t i = state_before(t);
  if (i + 1 == size() || t <= time(i)) return states_[i];
  return dense_->between(part_of(i).model, states_[i], states_[i + 1], t, reports_[i + 1]);
}

VectorXd Trajectory::positions_at(double t) const {
  const System& system = model(state_before(t)).system;
  VectorXd q(system.coordinates());
  system.expand(state_at(t).z, q);
  if (!stretch_.empty()) q += stretch_at(t);
  return whole_positions(structure(), q);
}

VectorXd Trajectory::velocities_at(double t) const {
  const System& system = model(state_before(t)).system;
  VectorXd v(system.coordinates());
  system.expand_rate(state_at(t).w, v);
  return whole_velocities(structure(), v);
}

}  // namespace unfurl
