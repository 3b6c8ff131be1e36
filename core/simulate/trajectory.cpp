#include "core/simulate/trajectory.hpp"

#include <algorithm>

namespace unfurl {

Trajectory::Trajectory(std::shared_ptr<const Model> model) : models_{{0, std::move(model)}} {}

void Trajectory::change_model(std::shared_ptr<const Model> model) {
  models_.push_back({size(), std::move(model)});
}

const Model& Trajectory::model(std::size_t i) const {
  std::size_t part = models_.size() - 1;
  while (part > 0 && models_[part].first > i) --part;
  return *models_[part].model;
}

void Trajectory::append(State state, StepReport report) {
  states_.push_back(std::move(state));
  reports_.push_back(report);
}

void Trajectory::pop_back() {
  states_.pop_back();
  reports_.pop_back();
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

VectorXd Trajectory::positions(std::size_t i) const {
  return whole_positions(structure(), node_positions(i));
}
VectorXd Trajectory::velocities(std::size_t i) const {
  return whole_velocities(structure(), node_velocities(i));
}

VectorXd Trajectory::positions_at(double t) const {
  const auto after = std::upper_bound(states_.begin(), states_.end(), t,
                                      [](double value, const State& s) { return value < s.t; });
  if (after == states_.begin()) return positions(0);
  if (after == states_.end()) return positions(size() - 1);
  const auto i = static_cast<std::size_t>(after - states_.begin()) - 1;
  const double h = time(i + 1) - time(i), u = (t - time(i)) / h;
  const double a = (1 + 2 * u) * (1 - u) * (1 - u), b = u * (1 - u) * (1 - u) * h, c = u * u * (3 - 2 * u),
               d = -u * u * (1 - u) * h;
  return a * positions(i) + b * velocities(i) + c * positions(i + 1) + d * velocities(i + 1);
}

}  // namespace unfurl
