// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/stops.hpp"

#include <algorithm>
#include <cmath>

#include "core/constraints/linear_rows.hpp"

namespace unfurl {
namespace {

std::string held_name(const StopSide& stop) {
  if (stop.reeled) return stop.name;
  return stop.name + (stop.sign > 0 ? " (held at its lower limit)" : " (held at its upper limit)");
}

}  // namespace

Stops::Stops(const Structure& structure) : of_length_(of_angle * reference_length(structure)) {
  const std::vector<int> followed = followed_angles(structure).of_stop;
  for (std::size_t i = 0; i < structure.stops.size(); ++i) {
    const Stop& stop = structure.stops[i];
    for (const double sign : {1.0, -1.0})
      if (const double limit = sign > 0 ? stop.min : stop.max; std::isfinite(limit))
        stops_.push_back({stop.name,
                          stop.measure,
                          MeasureFunction(stop.measure, structure.deployment),
                          limit,
                          sign,
                          stop.restitution,
                          stop.rest_speed,
                          followed[i],
                          static_cast<int>(i),
                          {},
                          false});
    if (stop.reeled)
      stops_.push_back({stop.name, stop.measure, MeasureFunction(stop.measure, structure.deployment),
                        stop.reel(0.0), -1.0, stop.restitution, stop.rest_speed, followed[i],
                        static_cast<int>(i), stop.reel, true});
  }
}

double Stops::gap(std::size_t i, const System& system, const State& state) const {
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  return stops_[i].sign * (stops_[i].function.value(q.data(), stops_[i].near(state)) - stops_[i].at(state.t));
}

double Stops::gap(std::size_t i, const State& state, const VectorXd& q, const VectorXd& v,
                  double& rate) const {
  const MeasureFunction& s = stops_[i].function;
  VectorXd gradient(static_cast<Index>(s.stencil().size()));
  const double value = s.value_and_gradient(q.data(), gradient.data(), stops_[i].near(state));
  rate = stops_[i].sign * (s.rate(gradient.data(), v.data()) - stops_[i].rate(state.t));
  return stops_[i].sign * (value - stops_[i].at(state.t));
}

double Stops::gap_rate(std::size_t i, const System& system, const State& state) const {
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  double rate = 0;
  gap(i, state, q, v, rate);
  return rate;
}

void Stops::stop_reels(double t) {
  for (StopSide& stop : stops_) {
    if (!stop.reeled) continue;
    TimeFunction still;
    still.offset = stop.reel(t);
    stop.reel = still;
  }
}

void Stops::hold(const std::set<std::size_t>& held, Structure& structure) const {
  for (const std::size_t i : held) {
    TimeFunction limit = stops_[i].reel;
    if (!stops_[i].reeled) limit.offset = stops_[i].limit;
    structure.constraints.push_back({"measure",
                                     held_name(stops_[i]),
                                     {},
                                     {},
                                     0.0,
                                     stops_[i].measure,
                                     limit,
                                     false,
                                     true,
                                     static_cast<int>(i)});
  }
}

bool Stops::is_held(std::size_t i, const Structure& structure) const {
  return std::ranges::any_of(structure.constraints,
                             [&](const Constraint& c) { return c.side == static_cast<int>(i); });
}

int Stops::held_row(std::size_t i, const Model& model, const std::set<std::size_t>& held) {
  const auto behind = std::distance(held.find(i), held.end());
  return model.system.constraint_row(static_cast<int>(std::ssize(model.structure.constraints) - behind));
}

double Stops::push(std::size_t i, const Model& model, const std::set<std::size_t>& held,
                   const State& state) const {
  return -stops_[i].sign * state.lambda[held_row(i, model, held)];
}

}  // namespace unfurl
