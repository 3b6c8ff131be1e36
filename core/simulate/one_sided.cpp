// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/one_sided.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/constraints/measure_rows.hpp"
#include "core/forces/spring.hpp"

namespace unfurl {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double handed_over = 1e4;  // of what counts as zero for a motor's torque
// Of what counts as touching: a distance within that is taken as one that grows, once it has come to zero.
constexpr double beside_zero = 100;
// So far behind its length a cable goes taut, of what counts as zero: by more than that is located to, so
// that it pulls there and does not push, by which a stop would be left that bears nothing else.
constexpr double just_taut = 0.02;

// Do they measure the same? Ends of a length may be told either way round.
bool same(const Measure& a, const Measure& b) {
  const bool turned = a.kind == MeasureKind::length &&
                      std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.rbegin(), b.nodes.rend());
  const auto same_term = [](const MeasureTerm& x, const MeasureTerm& y) {
    return x.coefficient == y.coefficient && same(x.measure, y.measure);
  };
  return a.kind == b.kind && (a.nodes == b.nodes || turned) && a.axis == b.axis &&
         a.reference == b.reference && std::ranges::equal(a.terms, b.terms, same_term);
}

// What a motor does now.
const char* in_words(const Motor& motor) {
  switch (motor.regime) {
    case Motor::Regime::forward:
      return " runs at full voltage";
    case Motor::Regime::backward:
      return " runs at full reverse voltage";
    case Motor::Regime::limit:
    case Motor::Regime::reverse_limit:
      return " runs at its current limit";
    case Motor::Regime::asked:
    case Motor::Regime::any:
      break;
  }
  return motor.control == Motor::Control::none ? " runs below its current limit" : " gives what is asked";
}

}  // namespace

OneSided::OneSided(const Structure& structure, const SolverOptions& options)
    : stops_(structure),
      step_(options.step),
      eliminate_linear_(options.eliminate_linear),
      rates_drift_(options.method != "dvm" && options.method != "rk4_projected") {
  const std::vector<int> followed = followed_angles(structure).of_force;
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const Force& f = structure.forces[i];
    if (f.one_sided && f.smoothing == 0 && (f.stiffness > 0 || f.damping > 0 || f.axial_stiffness > 0))
      cables_.push_back({i, f.name, MeasureFunction(f.measure, structure.deployment), f});
    if (f.kind == "motor" && bends(f.motor))
      motors_.push_back({i, f.name, MeasureFunction(f.measure, structure.deployment), followed[i], f});
    if (f.kind != "friction" || !(f.holding > 0 || PinLoads::arm(f) > 0)) continue;
    auto one = std::find_if(frictions_.begin(), frictions_.end(),
                            [&](const Friction& other) { return same(other.measure, f.measure); });
    if (one == frictions_.end()) {
      one = frictions_.insert(one,
                              {{}, f.measure, MeasureFunction(f.measure, structure.deployment), followed[i]});
      if (is_angle(f.measure)) one->row = row_arm(structure, f.measure);
    }
    one->pads.push_back({i, f.name, PinLoads::arm(f)});
    one->kinetic += f.kinetic;
    one->holding += f.holding;
  }
  active_.assign(first_motor() + motors_.size(), false);
  shift_.setZero(static_cast<Index>(stops_.size()));
  let_go_.setConstant(shift_.size(), unknown);
  held_force_.setZero(static_cast<Index>(first_motor()));
}

bool OneSided::any_active() const {
  return (laws() && !relaxed_) || std::find(active_.begin(), active_.end(), true) != active_.end() ||
         std::any_of(frictions_.begin(), frictions_.end(), [](const Friction& f) { return f.slip != 0; });
}

bool OneSided::any_reeled() const {
  for (std::size_t i = 0; i < stops_.size(); ++i)
    if (stops_[i].reeled && stops_[i].reel.moves()) return true;
  return std::any_of(cables_.begin(), cables_.end(),
                     [](const Cable& cable) { return cable.law.unstressed.moves(); });
}

bool OneSided::relax_laws() {
  std::fill_n(active_.begin() + static_cast<std::ptrdiff_t>(stops_.size()), cables_.size(), false);
  return !std::exchange(relaxed_, true) && laws();
}

void OneSided::turn_law(std::size_t i, const System& system, const State& state) {
  relaxed_ = false;
  if (!is_motor(i)) {
    active_[i] = !active_[i];
    return;
  }
  Drive& motor = motors_[i - first_motor()];
  Motor::Regime& regime = motor.law.motor.regime;
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  MotorRooms all = rooms(motor, q, v, state);
  if (regime != Motor::Regime::any)
    all[static_cast<std::size_t>(regime)] = std::numeric_limits<double>::lowest();
  regime = static_cast<Motor::Regime>(std::ranges::max_element(all) - all.begin());
  active_[i] = regime != Motor::Regime::asked;
  motor.shift = 0;
  motor.began = true;
}

const MeasureFunction& OneSided::measure(std::size_t i) const {
  return is_stop(i) ? stops_[i].function : friction(i).function;
}

double OneSided::near(std::size_t i, const State& state) const {
  if (is_stop(i)) return stops_[i].near(state);
  const Friction& f = friction(i);
  return f.followed >= 0 && f.followed < state.angles.size() ? state.angles[f.followed]
                                                             : f.function.reference();
}

LimitMotion OneSided::limit_motion(std::size_t i, double t) const {
  if (!is_stop(i) || !stops_[i].reeled) return {};
  return {stops_[i].reel.derivative(1, t), stops_[i].reel.derivative(2, t)};
}

void OneSided::set_slip(std::size_t i, int slip) {
  Friction& f = frictions_[i - first_friction()];
  f.reversed = !active_[i] && f.slip == -slip;
  f.slip = slip;
  active_[i] = false;
}

int OneSided::away_from_kink(std::size_t i, const System& system, const State& state) const {
  const Measure& what = friction(i).measure;
  const bool ends =
      what.kind == MeasureKind::length || (what.kind == MeasureKind::angle && !counts_turns(what));
  if (!ends) return 0;
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  return measure(i).is_angle() && measure(i).value(q.data(), near(i, state)) > pi / 2 ? -1 : 1;
}

bool OneSided::comes_to_zero(std::size_t i, const System& system, const State& state) const {
  if (!is_friction(i) || friction(i).measure.kind != MeasureKind::length) return false;
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  return measure(i).value(q.data()) <= beside_zero * touching(i);
}

void OneSided::stick(std::size_t i, const System& system, const State& state) {
  Friction& f = frictions_[i - first_friction()];
  if (active_[i]) return;
  VectorXd q(system.coordinates());
  system.expand(state.z, q);
  f.held_at = f.function.value(q.data(), near(i, state));
  f.slip = 0;
  active_[i] = true;
}

void OneSided::set_active(std::size_t i, bool active, double t) {
  active_[i] = active;
  if (is_stop(i)) let_go_[static_cast<Index>(i)] = active ? unknown : t;
}

void OneSided::archive(Archive& archive) {
  archive(active_);
  archive(relaxed_);
  archive(shift_);
  archive(let_go_);
  archive(shares_);
  for (Friction& f : frictions_) {
    archive(f.by_load);
    archive(f.slip);
    archive(f.held_at);
    archive(f.reversed);
  }
  for (Drive& motor : motors_) {
    auto regime = static_cast<int>(motor.law.motor.regime);
    archive(regime);
    archive(motor.shift);
    archive(motor.began);
    motor.law.motor.regime = static_cast<Motor::Regime>(regime);
  }
}

void OneSided::weigh(const Model& model, const State& state) {
  if (!PinLoads::any(model.structure)) return;
  if (!pin_loads_) pin_loads_ = std::make_unique<PinLoads>(model.structure, model.system.node_mass());
  const System system = model.system.at(state);
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  const double* const tension = state.tension.size() > 0 ? state.tension.data() : nullptr;
  const PinLoads::Loads loads = pin_loads_->evaluate(system.moment(state.t, tension), q.data(), v.data());
  for (Friction& f : frictions_) {
    f.by_load = 0;
    for (const Friction::Pad& pad : f.pads) f.by_load += pad.arm * loads.size[pad.force];
  }
}

std::set<std::size_t> OneSided::held() const {
  std::set<std::size_t> out;
  for (std::size_t i = 0; i < stops_.size(); ++i)
    if (active_[i]) out.insert(i);
  return out;
}

std::vector<Event> OneSided::events(std::size_t i, double t) const {
  std::vector<Event> out(is_friction(i) ? friction(i).pads.size() : 1, Event{.name = {}, .t = t});
  for (std::size_t k = 0; k < out.size(); ++k) tell(i, k, out[k]);
  return out;
}

void OneSided::tell(std::size_t i, std::size_t pad, Event& out) const {
  const bool on = active_[i];
  if (is_stop(i)) {
    out.element = stops_[i].name;
    if (stops_[i].reeled) {
      out.name = out.element + (on ? " pulls" : " is slack");
      out.kind = on ? "taut" : "slack";
      return;
    }
    out.name = (on ? "rests on stop " : "leaves stop ") + out.element;
    out.kind = on ? "contact" : "free";
  } else if (is_friction(i)) {
    const Friction& f = friction(i);
    out.element = f.pads[pad].name;
    out.kind = f.slip == 0 ? "stick" : f.reversed ? "reversal" : "slip";
    out.name = out.element + (f.slip == 0 ? " sticks" : f.reversed ? " slips the other way" : " slips");
  } else if (is_motor(i)) {
    const Drive& motor = motors_[i - first_motor()];
    out.element = motor.name;
    out.name = motor.name + in_words(motor.law.motor);
    out.kind = on ? "saturated" : "unsaturated";
  } else {
    out.element = cables_[i - stops_.size()].name;
    out.name = out.element + (on ? " pulls" : " is slack");
    out.kind = on ? "taut" : "slack";
  }
}

bool OneSided::touches(std::size_t i, const System& system, const State& state) const {
  return active_[i] || stops_.gap(i, system, state) - shift_[static_cast<Index>(i)] <= touching(i);
}

void OneSided::touch(const System& system, const State& state) {
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    const double gap = stops_.gap(i, system, state);
    shift_[static_cast<Index>(i)] = active_[i] ? 0.0 : std::min(0.0, gap);
    if (state.t > let_go_[static_cast<Index>(i)] && gap > touching(i)) set_active(i, false);
  }
  if (std::ranges::none_of(motors_, &Drive::began)) return;
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  for (Drive& motor : motors_)
    if (std::exchange(motor.began, false))
      if (const double left = room(motor, q, v, state); left > -handed_over)
        motor.shift = std::min(0.0, left);
}

void OneSided::find_laws(const System& system, const State& state) {
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  double rate = 0;
  for (std::size_t k = 0; k < cables_.size(); ++k)
    active_[stops_.size() + k] = stretch(cables_[k], state.t, q, v, rate) > stops_.touching();
  for (std::size_t k = 0; k < motors_.size(); ++k) {
    motors_[k].law.motor.regime = Motor::Regime::any;
    turn_law(first_motor() + k, system, state);
  }
}

MotorRooms OneSided::rooms(const Drive& motor, const VectorXd& q, const VectorXd& v, const State& state) {
  gradient_.resize(static_cast<Index>(motor.measure.stencil().size()));
  Moment at(state.t);
  at.since = state.t;
  at.angles = at.rates = state.angles.data();  // no time has passed: no rate counts
  return motor_rooms(motor.law, motor.measure, motor.followed, at, q.data(), v.data(), gradient_.data());
}

// min(s - rest, n / (k + c / h)) [m]
double OneSided::stretch(const Cable& cable, double t, const VectorXd& q, const VectorXd& v, double& rate) {
  const SpringLaw law = spring_law(cable.law, t, q.data());
  const double damping = cable.law.damping;
  gradient_.resize(static_cast<Index>(cable.length.stencil().size()));
  const double s = cable.length.value_and_gradient(q.data(), gradient_.data()) - law.rest;
  const double ds = cable.length.rate(gradient_.data(), v.data());
  const double stretching = ds - law.rest_rate;
  const double n = law.stiffness * s + damping * stretching;
  const double by_force = damping > 0 ? n / (law.stiffness + damping / step_) : s;
  rate = s <= by_force ? stretching : unknown;
  return std::min(s, by_force);
}

// Of a cable or motor.
double OneSided::law_margin(std::size_t i, const State& state, const VectorXd& q, const VectorXd& v,
                            double& rate) {
  if (is_motor(i)) {
    const Drive& motor = motors_[i - first_motor()];
    rate = unknown;
    return room(motor, q, v, state) - motor.shift;
  }
  const double sign = active_[i] ? 1.0 : -1.0, zero = stops_.touching();
  const double margin = sign * stretch(cables_[i - stops_.size()], state.t, q, v, rate);
  rate = sign * rate / zero;
  return margin / zero + (active_[i] ? 0.0 : just_taut);
}

std::vector<std::size_t> OneSided::laws_left(const System& system, const State& state) {
  std::vector<std::size_t> out;
  if (!laws() || relaxed_) return out;
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  double rate = 0;
  for (std::size_t i = stops_.size(); i < active_.size(); ++i)
    if (!is_friction(i) && law_margin(i, state, q, v, rate) < -1) out.push_back(i);
  return out;
}

void OneSided::measure_friction(const VectorXd& q, const VectorXd& v, const State& state, std::size_t i,
                                Probe& probe) {
  const Friction& f = friction(i);
  gradient_.resize(static_cast<Index>(f.function.stencil().size()));
  const double value = f.function.value_and_gradient(q.data(), gradient_.data(), near(i, state));
  double rate = f.function.rate(gradient_.data(), v.data());
  if (f.measure.kind == MeasureKind::length && value <= (f.slip > 0 ? beside_zero : 1) * touching(i))
    rate = std::abs(rate);
  probe.margins[static_cast<Index>(i)] =
      f.slip != 0 ? f.slip * rate / rounded_rate(i) : 2 - std::abs(rate) / zero_rate(i);
}

void OneSided::measure(const Model& model, const State& state, bool forces, Probe& probe) {
  const System& system = model.system;
  const auto count = static_cast<Index>(active_.size()), stops = static_cast<Index>(stops_.size());
  probe.margins = probe.rates = VectorXd::Constant(count, unknown);
  probe.forces.setZero(count);
  bool holds = false;
  for (std::size_t k = 0; k < active_.size(); ++k)
    holds = holds || (active_[k] && (is_stop(k) || is_friction(k)));
  VectorXd q(system.coordinates()), v(q.size()), v_met;
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  // Friction turns round where a drive does, not where the method's rates do.
  if (forces && rates_drift_ && any_friction()) {
    follow(model, state);
    VectorXd w = state.w;
    if (index1_->evaluate_on(state.t, state.z, w, acceleration_, lambda_, state.tension))
      system.expand_rate(w, v_met = v);
  }
  for (Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if ((i < stops || is_friction(k)) && active_[k]) continue;
    if (is_friction(k)) {
      measure_friction(q, v_met.size() > 0 ? v_met : v, state, k, probe);
      continue;
    }
    if (i >= stops) {
      probe.margins[i] = law_margin(k, state, q, v, probe.rates[i]);
      continue;
    }
    double& rate = probe.rates[i];
    const double gap = stops_.gap(k, state, q, v, rate) - shift_[i];
    probe.margins[i] = gap / touching(k);
    if (probe.margins[i] < -1 && leaves(k, model, state, -gap, rate)) probe.margins[i] = -0.5;
    rate /= touching(k);
  }
  if (forces && holds) measure_held(model, state, probe);
}

std::shared_ptr<const Model> OneSided::stop_reels(const Model& base, double t) {
  Structure structure = base.structure;
  stops_.stop_reels(t);
  const auto still = [t](const TimeFunction& law) {
    TimeFunction constant;
    constant.offset = law(t);
    return constant;
  };
  for (Stop& stop : structure.stops)
    if (stop.reeled) stop.reel = still(stop.reel);
  // At a rate of zero: it still is a cable that was drawn in, with what it gives among the run's columns.
  const auto stop = [&](Force& force) {
    if (!force.unstressed.moves()) return;
    force.unstressed = still(force.unstressed);
    force.unstressed.kind = TimeFunction::Kind::rate;
  };
  std::for_each(structure.forces.begin(), structure.forces.end(), stop);
  for (Cable& cable : cables_) stop(cable.law);
  for (std::size_t i = 0; i < stops_.size(); ++i) active_[i] = active_[i] && !stops_[i].reeled;
  System system(structure, eliminate_linear_);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

void OneSided::set_laws(Structure& structure) const {
  for (std::size_t k = 0; k < cables_.size(); ++k)
    if (active_[stops_.size() + k])
      structure.forces[cables_[k].force].one_sided = false;
    else
      structure.forces[cables_[k].force].slack = !relaxed_;
  for (const Drive& motor : motors_)
    structure.forces[motor.force].motor.regime = relaxed_ ? Motor::Regime::any : motor.law.motor.regime;
}

Model OneSided::without_holds(const Model& base) const {
  if (!laws()) return base;
  Structure structure = base.structure;
  set_laws(structure);
  System system(structure, eliminate_linear_);
  return {std::move(structure), std::move(system)};
}

std::shared_ptr<const Model> OneSided::model(const Model& base) const {
  Structure structure = base.structure;
  set_laws(structure);
  for (std::size_t k = 0; k < frictions_.size(); ++k) {
    const Friction& f = frictions_[k];
    for (const Friction::Pad& pad : f.pads) structure.forces[pad.force].slip = f.slip;
    if (!active_[first_friction() + k]) continue;
    TimeFunction held_at;
    held_at.offset = f.held_at;
    structure.constraints.push_back(
        {"measure", f.pads.front().name + " (sticks)", {}, {}, 0.0, f.measure, held_at, false, true});
  }
  stops_.hold(held(), structure);
  System system(structure, eliminate_linear_);
  return std::make_shared<const Model>(Model{std::move(structure), std::move(system)});
}

}  // namespace unfurl
