// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/one_sided.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/forces/spring.hpp"

namespace unfurl {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double force_zero = 1e-10;  // of the largest multiplier

}  // namespace

OneSided::OneSided(const Structure& structure, const SolverOptions& options)
    : stops_(structure), step_(options.step), eliminate_linear_(options.eliminate_linear) {
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const Force& f = structure.forces[i];
    if (f.one_sided && f.smoothing == 0 && (f.stiffness > 0 || f.damping > 0 || f.axial_stiffness > 0))
      cables_.push_back({i, f.name, MeasureFunction(f.measure, structure.deployment), f});
  }
  active_.assign(stops_.size() + cables_.size(), false);
  shift_.setZero(static_cast<Index>(stops_.size()));
}

bool OneSided::any_active() const {
  return std::find(active_.begin(), active_.end(), true) != active_.end();
}

bool OneSided::any_held() const {
  return !held().empty();
}

bool OneSided::relax_cables() {
  const auto cables = active_.begin() + static_cast<std::ptrdiff_t>(stops_.size());
  const bool any = std::find(cables, active_.end(), true) != active_.end();
  std::fill(cables, active_.end(), false);
  return any;
}

std::set<std::size_t> OneSided::held() const {
  std::set<std::size_t> out;
  for (std::size_t i = 0; i < stops_.size(); ++i)
    if (active_[i]) out.insert(i);
  return out;
}

std::string OneSided::text(std::size_t i) const {
  if (is_stop(i) && stops_[i].reeled) return stops_[i].name + (active_[i] ? " pulls" : " is slack");
  if (is_stop(i)) return (active_[i] ? "rests on stop " : "leaves stop ") + stops_[i].name;
  return cables_[i - stops_.size()].name + (active_[i] ? " pulls" : " is slack");
}

void OneSided::touch(const System& system, const State& state) {
  for (std::size_t i = 0; i < stops_.size(); ++i)
    shift_[static_cast<Index>(i)] = active_[i] ? 0.0 : std::min(0.0, stops_.gap(i, system, state));
}

void OneSided::find_modes(const System& system, const State& state) {
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  double rate = 0;
  for (std::size_t k = 0; k < cables_.size(); ++k)
    active_[stops_.size() + k] = stretch(cables_[k], state.t, q, v, rate) > stops_.touching();
}

// min(s - rest, n / (k + c / h)) [m]
double OneSided::stretch(const Cable& cable, double t, const VectorXd& q, const VectorXd& v, double& rate) {
  const SpringLaw law = spring_law(cable.law, t);
  const double damping = cable.law.damping;
  gradient_.resize(static_cast<Index>(cable.length.stencil().size()));
  const double s = cable.length.value_and_gradient(q.data(), gradient_.data()) - law.rest;
  const double ds = cable.length.rate(gradient_.data(), v.data());
  const double stretching = ds - law.rest_rate;
  rate = damping > 0 ? unknown : stretching;
  const double n = law.stiffness * s + damping * ds;
  return damping > 0 ? std::min(s, n / (law.stiffness + damping / step_)) : s;
}

void OneSided::measure_pushes(const Model& model, const State& state, Probe& probe) {
  if (!index1_) {
    followed_.emplace(model.system);
    index1_ = std::make_unique<Index1>(*followed_);
  }
  followed_->follow(state);
  acceleration_.resize(state.z.size());
  lambda_ = state.lambda;
  State with_forces = state;
  if (index1_->evaluate(state.t, state.z, state.w, acceleration_, lambda_)) with_forces.lambda = lambda_;
  const double zero =
      std::max(force_zero * with_forces.lambda.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
  const std::set<std::size_t> held = this->held();
  for (const std::size_t i : held)
    probe.margins[static_cast<Index>(i)] = stops_.push(i, model, held, with_forces) / zero;
}

void OneSided::measure(const Model& model, const State& state, bool forces, Probe& probe) {
  const System& system = model.system;
  const auto count = static_cast<Index>(active_.size()), stops = static_cast<Index>(stops_.size());
  probe.margins = probe.rates = VectorXd::Constant(count, unknown);
  if (forces && any_held()) measure_pushes(model, state, probe);
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  for (Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i < stops && active_[k]) continue;
    double rate = 0, margin = 0;
    if (i < stops) {
      margin = stops_.gap(k, state, q, v, rate) - shift_[i];
    } else {
      const double sign = active_[k] ? 1.0 : -1.0;
      margin = sign * stretch(cables_[k - stops_.size()], state.t, q, v, rate);
      rate *= sign;
    }
    probe.margins[i] = margin / stops_.touching();
    probe.rates[i] = rate / stops_.touching();
  }
}

std::shared_ptr<const Model> OneSided::lock_held(const Model& base, double t) {
  Structure structure = base.structure;
  std::set<std::size_t> locked = held();
  std::erase_if(locked, [&](std::size_t i) { return stops_[i].reeled; });  // the winch stops
  stops_.hold(locked, structure);
  stops_.stop_reels(t);
  std::fill_n(active_.begin(), stops_.size(), false);
  System system(structure, eliminate_linear_);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

std::shared_ptr<const Model> OneSided::model(const Model& base) const {
  Structure structure = base.structure;
  for (std::size_t k = 0; k < cables_.size(); ++k)
    if (active_[stops_.size() + k]) structure.forces[cables_[k].force].one_sided = false;
  stops_.hold(held(), structure);
  System system(structure, eliminate_linear_);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

}  // namespace unfurl
