// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/forces/spring.hpp"
#include "core/structure/motion_params.hpp"
#include "core/structure/node_positions.hpp"
#include "core/structure/structure_error.hpp"

namespace unfurl {
namespace {

// Of the structure's: of no meaning, left out of energies (System::kinetic_energy), and small beside what
// moves.
constexpr double integrator_mass = 1e-6;

struct MotorOn {
  Force force;
  MeasureFunction measure;
  int followed;
  double ghost_mass;  // of its integrator
};

class Motors final : public ForceBlock {
 public:
  explicit Motors(std::vector<MotorOn> motors) : motors_(std::move(motors)) {}
  bool constant() const override { return false; }
  bool has_power() const override { return true; }

  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override {
    std::vector<double> g;
    for (const MotorOn& motor : motors_) {
      const MotorState now = state(motor, at, q, v, g);
      const auto& stencil = motor.measure.stencil();
      for (std::size_t i = 0; i < stencil.size(); ++i) f[stencil[i]] += scale * now.effort * g[i];
      if (const int ghost = motor.force.motor.integrator; ghost >= 0)
        f[3 * ghost] += scale * motor.ghost_mass * (motor.force.motor.command.derivative(1, at.t) - now.rate);
    }
  }

  double power(const Moment& at, const double* q, const double* v) const override {
    std::vector<double> g;
    double sum = 0;
    for (const MotorOn& motor : motors_) {
      const MotorState now = state(motor, at, q, v, g);
      sum += now.effort * now.rate;
    }
    return sum;
  }

  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    std::vector<double> g, turned;
    for (const MotorOn& motor : motors_) {
      const MotorState now = state(motor, at, q, v, g);
      const auto& stencil = motor.measure.stencil();
      turned.assign(stencil.size(), 0.0);
      motor.measure.add_hessian(q, now.effort, by_q);
      motor.measure.add_hessian_times(q, v, 1.0, turned.data());
      const int ghost = 3 * motor.force.motor.integrator;
      for (std::size_t j = 0; j < stencil.size(); ++j) {
        for (std::size_t i = 0; i < stencil.size(); ++i) {
          by_q.emplace_back(stencil[i], stencil[j], g[i] * (now.by_value * g[j] + now.by_rate * turned[j]));
          by_v.emplace_back(stencil[i], stencil[j], now.by_rate * g[i] * g[j]);
        }
        if (ghost < 0) continue;
        by_q.emplace_back(stencil[j], ghost, g[j] * now.by_integral);
        by_q.emplace_back(ghost, stencil[j], -motor.ghost_mass * turned[j]);
        by_v.emplace_back(ghost, stencil[j], -motor.ghost_mass * g[j]);
      }
    }
  }

 private:
  static MotorState state(const MotorOn& motor, const Moment& at, const double* q, const double* v,
                          std::vector<double>& g) {
    g.resize(motor.measure.stencil().size());
    return motor_state(motor.force, motor.measure, motor.followed, at, q, v, g.data());
  }

  std::vector<MotorOn> motors_;
};

// What a controller asks of the motor, at the measure, with its derivatives.
void ask(const Motor& m, double t, const double* q, MotorState& s) {
  const double error = m.command(t) - s.value, error_rate = m.command.derivative(1, t) - s.rate;
  if (m.control == Motor::Control::rate) {
    s.effort = m.proportional * error_rate + m.integral * error;
    s.by_value = -m.integral;
    s.by_rate = -m.proportional;
    return;
  }
  s.effort = m.proportional * error + m.derivative * error_rate;
  s.by_value = -m.proportional;
  s.by_rate = -m.derivative;
  if (m.integrator < 0) return;
  s.effort += m.integral * q[3 * m.integrator];
  s.by_integral = m.integral;
}

// Of the motor [N m] or [N], at a share of the full voltage and a rate of the measure.
double full_torque(const Motor& m, double voltage, double rate) {
  return m.stall * (voltage - m.gear_ratio * rate / m.no_load_speed);
}

void at_voltage(const Motor& m, double voltage, MotorState& s) {
  s.effort = m.gear_ratio * full_torque(m, voltage, s.rate);
  s.by_value = s.by_integral = 0;
  s.by_rate = -m.gear_ratio * m.gear_ratio * m.stall / m.no_load_speed;
}

// Value and rate with what voltage or controller asks for, cut by nothing.
MotorState asked_state(const Force& motor, const MeasureFunction& measure, int followed, const Moment& at,
                       const double* q, const double* v, double* gradient) {
  const Motor& m = motor.motor;
  MotorState s;
  s.value = measure.value_and_gradient(q, v, gradient, at, followed);
  s.rate = measure.rate(gradient, v);
  if (m.control == Motor::Control::none)
    at_voltage(m, m.command(at.t), s);
  else
    ask(m, at.t, q, s);
  return s;
}

// The part of the law that the state asks for.
Motor::Regime regime_of(const Motor& m, const MotorState& asked) {
  using Regime = Motor::Regime;
  if (m.regime != Regime::any) return m.regime;
  double torque = asked.effort / m.gear_ratio;
  Regime regime = Regime::asked;
  if (m.control != Motor::Control::none)
    for (const double voltage : {1.0, -1.0})
      if (const double full = full_torque(m, voltage, asked.rate); voltage * torque > voltage * full)
        torque = full, regime = voltage > 0 ? Regime::forward : Regime::backward;
  if (std::abs(torque) <= m.limit) return regime;
  return torque > 0 ? Regime::limit : Regime::reverse_limit;
}

}  // namespace

MotorState motor_state(const Force& motor, const MeasureFunction& measure, int followed, const Moment& at,
                       const double* q, const double* v, double* gradient) {
  using Regime = Motor::Regime;
  const Motor& m = motor.motor;
  MotorState s = asked_state(motor, measure, followed, at, q, v, gradient);
  const Regime regime = regime_of(m, s);
  if (regime == Regime::forward || regime == Regime::backward)
    at_voltage(m, regime == Regime::forward ? 1.0 : -1.0, s);
  if (regime == Regime::limit || regime == Regime::reverse_limit) {
    s.effort = (regime == Regime::limit ? 1.0 : -1.0) * m.gear_ratio * m.limit;
    s.by_value = s.by_rate = s.by_integral = 0;
  }
  return s;
}

MotorRooms motor_rooms(const Force& motor, const MeasureFunction& measure, int followed, const Moment& at,
                       const double* q, const double* v, double* gradient) {
  constexpr double share = 1e-10, rounding = 1e-13;
  const Motor& m = motor.motor;
  const MotorState s = asked_state(motor, measure, followed, at, q, v, gradient);
  const double asked = s.effort / m.gear_ratio, limit = m.limit;
  double forward = std::numeric_limits<double>::infinity(), backward = -forward;
  double zero = share * std::min(m.stall, m.limit) + rounding * std::abs(asked);
  if (m.control != Motor::Control::none) {
    forward = full_torque(m, 1, s.rate), backward = full_torque(m, -1, s.rate);
    zero +=
        rounding * (std::abs(s.by_value * s.value) + std::abs(s.by_rate * s.rate)) / std::abs(m.gear_ratio);
  }
  const double cut = std::clamp(asked, backward, forward);
  MotorRooms rooms = {std::min({forward - asked, asked - backward, limit - std::abs(asked)}),
                      std::min(asked - forward, limit - std::abs(forward)),
                      std::min(backward - asked, limit - std::abs(backward)), cut - limit, -limit - cut};
  for (double& room : rooms) room /= zero;
  return rooms;
}

bool bends(const Motor& m) {
  return m.control != Motor::Control::none || std::isfinite(m.limit);
}

std::unique_ptr<ForceBlock> motor_block(const Structure& structure, const SparseRows&) {
  std::vector<MotorOn> motors;
  const std::vector<int> followed = followed_angles(structure).of_force;
  for (std::size_t i = 0; i < structure.forces.size(); ++i)
    if (const Force& f = structure.forces[i]; f.kind == "motor")
      motors.push_back({f, MeasureFunction(f.measure, structure.deployment), followed[i],
                        f.motor.integrator < 0
                            ? 0.0
                            : structure.nodes[static_cast<std::size_t>(f.motor.integrator)].mass});
  if (motors.empty()) return nullptr;
  return std::make_unique<Motors>(std::move(motors));
}

int add_ghost(Structure& structure, const std::string& name, double mass, double rate) {
  const auto node = static_cast<int>(structure.nodes.size());
  structure.nodes.push_back({name, Vec3::Zero(), Vec3(rate, 0, 0), mass, true});
  for (const int k : {1, 2})
    structure.constraints.push_back(
        {"plane", name + (k == 1 ? " y" : " z"), {node}, {Vec3::Unit(k)}, 0.0, {}, {}});
  return node;
}

namespace {

// How fast the nodes' own velocities turn the joint.
double joint_rate(const Structure& structure, const Measure& joint) {
  const MeasureFunction measure(joint, structure.deployment);
  const VectorXd q = node_positions(structure);
  VectorXd v(q.size()), gradient(std::ssize(measure.stencil()));
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    v.segment<3>(3 * static_cast<Index>(i)) = structure.nodes[i].velocity;
  measure.value_and_gradient(q.data(), gradient.data());
  const double rate = measure.rate(gradient.data(), v.data());
  return std::isfinite(rate) ? rate : 0.0;
}

}  // namespace

void add_rotor(Structure& structure, double inertia, double initial) {
  const Force motor = structure.forces.back();
  const double n = motor.motor.gear_ratio;
  const int rotor =
      add_ghost(structure, "rotor of " + motor.name, n * n * inertia, joint_rate(structure, motor.measure));
  Measure tie;
  tie.kind = MeasureKind::combination;
  tie.terms = motor.measure.terms;
  if (tie.terms.empty()) tie.terms = {{1.0, motor.measure}};
  tie.terms.push_back({-1.0, {MeasureKind::coordinate, {rotor}, Vec3::UnitX(), 0.0, {}}});
  TimeFunction start;
  start.offset = initial;
  structure.constraints.push_back({"measure", "rotor of " + motor.name, {}, {}, 0.0, tie, start});
}

void add_integrator(Structure& structure, double initial) {
  const Force& motor = structure.forces.back();
  double mass = 0;
  for (const Node& node : structure.nodes) mass += node.ghost ? 0.0 : node.mass;
  for (const Rod& rod : structure.rods) mass += rod.mass;
  const int ghost = add_ghost(structure, "integral of " + motor.name,
                              integrator_mass * (mass > 0 ? mass : 1.0), motor.motor.command(0.0) - initial);
  structure.forces.back().motor.integrator = ghost;
}

namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

std::vector<ParamSpec> motor_own_params(std::string_view unit) {
  const bool turns = unit == "deg";
  ParamSpec stall = positive_param("stall_torque", "N m", 1.0, "of the motor at rest, at full voltage"),
            speed = positive_param("no_load_speed", "deg/s", 1.0, "of the motor, where it gives no torque");
  stall.required = speed.required = true;
  std::vector<ParamSpec> all = {
      stall,
      speed,
      real_param("gear_ratio", "", 1.0, -no_limit, no_limit,
                 turns ? "turns of the motor for one of the joint; negative: the other way"
                       : "turns of the motor for one of the drum"),
      positive_param("current_limit", "A", no_limit, "most that the motor takes; with torque_constant"),
      only_given("current_limit",
                 positive_param("torque_constant", "N m/A", std::numeric_limits<double>::quiet_NaN(),
                                "torque per ampere")),
      choice_param("control", "voltage", {"voltage", "position", "rate"},
                   "voltage: a share of the full one; position, rate: a controller that follows the motion"),
      only_with(
          "control", {"voltage"},
          real_param("voltage", "", 1.0, -1.0, 1.0, "share of the full voltage; its sign is the direction")),
      only_with("control", {"position", "rate"},
                real_param("proportional", turns ? "N m/rad" : "N/m", 0.0, 0.0, no_limit,
                           "effort per error of the value, or of its rate (then per second)")),
      only_with("control", {"position", "rate"},
                real_param("integral", "", 0.0, 0.0, no_limit, "effort per integral of that error")),
      only_with("control", {"position"},
                real_param("derivative", turns ? "N m s/rad" : "N s/m", 0.0, 0.0, no_limit,
                           "effort per rate of the error"))};
  for (ParamSpec& spec : motion_params(unit))
    all.push_back(spec.name == "motion" ? only_with("control", {"position", "rate"}, std::move(spec))
                                        : std::move(spec));
  return all;
}

}  // namespace

const std::vector<ParamSpec>& motor_params() {
  static const std::vector<ParamSpec> params = [] {
    std::vector<ParamSpec> all = motor_own_params("deg");
    all.push_back(real_param("inertia", "kg m^2", 0.0, 0.0, no_limit, "of the rotor, seen through the gear"));
    all.push_back(vector_param(
        "axis", "", {0, 0, 0},
        "of the hinge: the angle then has a sign and counts any number of turns; none: in [0, 180]"));
    return all;
  }();
  return params;
}

const std::vector<ParamSpec>& winch_params() {
  static const std::vector<ParamSpec> params = [] {
    std::vector<ParamSpec> all = motor_own_params("m");
    for (ParamSpec& spec : all)
      if (spec.name == "to") spec.help = "smooth: the value in the end: the length drawn in since t = 0";
    ParamSpec radius = positive_param("drum_radius", "m", 1.0, "of the drum that draws the cable in"),
              inertia = positive_param("inertia", "kg m^2", 1.0, "of rotor and drum, at the motor");
    radius.required = inertia.required = true;
    all.insert(all.end(), {radius, inertia,
                           real_param("axial_stiffness", "N", 0.0, 0.0, no_limit,
                                      "E A of an elastic cable; 0: it does not stretch"),
                           positive_param("length", "m", std::numeric_limits<double>::quiet_NaN(),
                                          "unstressed, at t = 0; by default the length of its path there"),
                           only_given("axial_stiffness", real_param("damping", "N s/m", 0.0, 0.0, no_limit,
                                                                    "of an elastic cable, per m/s")),
                           pulley_friction_param(), pulley_creep_param()});
    return all;
  }();
  return params;
}

void fill_motor(const ParamSet& values, Force& force) {
  Motor& m = force.motor;
  m.stall = values.real("stall_torque");
  m.no_load_speed = values.real("no_load_speed") * radians_per_degree;
  m.gear_ratio = values.real("gear_ratio");
  if (m.gear_ratio == 0.0) throw StructureError("gear_ratio", "must not be 0: such a gear turns nothing");
  const double current = values.real("current_limit"), constant = values.real("torque_constant");
  if (std::isfinite(current) && std::isnan(constant))
    throw StructureError("torque_constant", "is missing; current_limit needs it");
  if (std::isfinite(current)) m.limit = current * constant;
  const std::string& control = values.text("control");
  m.control = control == "rate"       ? Motor::Control::rate
              : control == "position" ? Motor::Control::position
                                      : Motor::Control::none;
  m.proportional = values.real("proportional");
  m.integral = values.real("integral");
  const bool by_rate = m.control == Motor::Control::rate;
  m.derivative = by_rate ? 0.0 : values.real("derivative");
  if (m.control != Motor::Control::none && m.proportional + m.integral + m.derivative == 0.0)
    throw StructureError("proportional", by_rate ? "is missing, and so is integral: it would do nothing"
                                                 : "is missing, and so are integral and derivative: it would "
                                                   "do nothing");
  const double unit = is_angle(force.measure) ? radians_per_degree : 1.0;
  if (m.control == Motor::Control::none)
    m.command.offset = values.real("voltage");
  else
    m.command = motion_function(values, force.rest, unit);
  // The integral of the rate's error is the change of both since t = 0, whatever values a table goes through.
  if (m.control == Motor::Control::rate) m.command.offset += force.rest - m.command(0.0);
}

}  // namespace unfurl
