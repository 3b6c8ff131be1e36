// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/entry_turns.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/structure/measure.hpp"

namespace unfurl {
namespace {

// What rounding leaves of one number that was computed in two ways, as a share of its size.
constexpr double rounding_share = 1e-13;

bool alike(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || a == b;
}
bool close_to(double a, double b) {
  return alike(a, b) || std::abs(a - b) <= rounding_share * std::max(std::abs(a), std::abs(b));
}
bool close_to(const Vec3& a, const Vec3& b) {
  return (a.array().isNaN().all() && b.array().isNaN().all()) ||
         (a - b).norm() <= rounding_share * std::max(a.norm(), b.norm());
}
bool close_to(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Vec3& x, const Vec3& y) { return close_to(x, y); });
}

// The names of all members stand in each of these: one that is added later does not compile here until
// somebody has said how it compares.

bool alike(const TimeFunction& a, const TimeFunction& b) {
  const auto& [kind, offset, rate, ramp, rise, start, duration, times, values, bends] = a;
  return kind == b.kind && offset == b.offset && rate == b.rate && ramp == b.ramp && rise == b.rise &&
         start == b.start && duration == b.duration && times == b.times && values == b.values &&
         bends == b.bends;
}

// Of an angle, a radian.
double unit_of(const Measure& measure, double size) {
  return is_angle(measure) ? 1.0 : size;
}

// A drive that begins at the value of the start has it from the nodes, to rounding of what they measure.
bool same_target(const TimeFunction& a, TimeFunction b, double unit) {
  const double most = unit + std::max(std::abs(a.offset), std::abs(a.offset + a.rise));
  if (std::abs(a.offset - b.offset) > rounding_share * most) return false;
  if (std::abs(a.rise - b.rise) > rounding_share * most) return false;
  b.offset = a.offset;
  b.rise = a.rise;
  return alike(a, b);
}

bool alike(const Motor& a, const Motor& b, double unit) {
  const auto& [stall, no_load_speed, gear_ratio, limit, control, proportional, integral, derivative, command,
               integrator, regime] = a;
  return stall == b.stall && no_load_speed == b.no_load_speed && gear_ratio == b.gear_ratio &&
         limit == b.limit && control == b.control && proportional == b.proportional &&
         integral == b.integral && derivative == b.derivative && same_target(command, b.command, unit) &&
         integrator == b.integrator && regime == b.regime;
}

bool same_angle(double a, double b) {
  return alike(a, b) || std::abs(a - b) <= 1e-9;  // it only says which turn is meant
}

}  // namespace

std::vector<int> NodeTurn::nodes(const std::vector<int>& from) const {
  std::vector<int> out;
  for (const int node : from) out.push_back(to[static_cast<std::size_t>(node)]);
  return out;
}

Measure NodeTurn::measure(const Measure& from) const {
  Measure out = from;
  out.nodes = nodes(from.nodes);
  out.axis = turn * from.axis;
  for (MeasureTerm& term : out.terms) term.measure = measure(term.measure);
  return out;
}

LinearForm NodeTurn::form(const LinearForm& from) const {
  LinearForm out = from;
  out.nodes = nodes(from.nodes);
  for (Vec3& c : out.coefficients) c = turn * c;
  return out;
}

Force NodeTurn::force(const Force& from) const {
  Force out = from;
  out.nodes = nodes(from.nodes);
  out.measure = measure(from.measure);
  out.direction = turn * from.direction;
  return out;
}

Constraint NodeTurn::constraint(const Constraint& from) const {
  Constraint out = from;
  out.nodes = nodes(from.nodes);
  out.measure = measure(from.measure);
  for (Vec3& v : out.vectors) v = turn * v;
  return out;
}

bool same_entry(const Measure& a, const Measure& b) {
  const auto& [kind, nodes, axis, reference, terms] = a;
  if (kind != b.kind || terms.size() != b.terms.size()) return false;
  const bool turned_round = kind == MeasureKind::length && nodes.size() == 2 && b.nodes.size() == 2 &&
                            nodes[0] == b.nodes[1] && nodes[1] == b.nodes[0];
  if ((nodes != b.nodes && !turned_round) || !close_to(axis, b.axis) || !same_angle(reference, b.reference))
    return false;
  return std::equal(terms.begin(), terms.end(), b.terms.begin(), [](const auto& x, const auto& y) {
    const auto& [coefficient, measure] = x;
    return close_to(coefficient, y.coefficient) && same_entry(measure, y.measure);
  });
}

bool same_entry(const Force& a, const Force& b, double size_of_all) {
  const auto& [kind, name, nodes, measure, stiffness, damping, rest, one_sided, slack, smoothing,
               axial_stiffness, unstressed, motor, direction, size, expansion, form, kinetic, holding, slip,
               rope, trolley] = a;
  return kind == b.kind && nodes == b.nodes && same_entry(measure, b.measure) && stiffness == b.stiffness &&
         damping == b.damping &&
         (close_to(rest, b.rest) ||
          std::abs(rest - b.rest) <= rounding_share * unit_of(measure, size_of_all)) &&
         one_sided == b.one_sided && slack == b.slack && smoothing == b.smoothing &&
         axial_stiffness == b.axial_stiffness && alike(unstressed, b.unstressed) &&
         alike(motor, b.motor, unit_of(measure, size_of_all)) && close_to(direction, b.direction) &&
         alike(size, b.size) && expansion == b.expansion && form.empty() && b.form.empty() &&
         kinetic == b.kinetic && holding == b.holding && slip == b.slip && alike(rope, b.rope) &&
         close_to(trolley, b.trolley);
}

bool same_entry(const Constraint& a, const Constraint& b, double size_of_all) {
  const auto& [kind, name, nodes, vectors, value, measure, target, symmetry, of_stop, side] = a;
  return kind == b.kind && nodes == b.nodes && close_to(vectors, b.vectors) && close_to(value, b.value) &&
         same_entry(measure, b.measure) && same_target(target, b.target, unit_of(measure, size_of_all)) &&
         symmetry == b.symmetry && of_stop == b.of_stop && side == b.side;
}

bool same_entry(const Rod& x, const Rod& y) {
  const auto& [name, a, b, mass, length, group, radius, multiplicity, area, youngs_modulus, second_moment,
               strength, gives, damping_time, free_length, expansion, warming, parts, whole] = x;
  return std::minmax(a, b) == std::minmax(y.a, y.b) && close_to(mass, y.mass) && close_to(length, y.length) &&
         multiplicity == y.multiplicity && area == y.area && youngs_modulus == y.youngs_modulus &&
         second_moment == y.second_moment && strength == y.strength && gives == y.gives &&
         close_to(damping_time, y.damping_time) && close_to(free_length, y.free_length) &&
         expansion == y.expansion && alike(warming, y.warming) && parts == y.parts;
}

bool same_form(const LinearForm& a, const LinearForm& b) {
  const auto sums = [](const LinearForm& form) {
    std::map<int, Vec3> out;
    for (std::size_t i = 0; i < form.nodes.size(); ++i)
      out.try_emplace(form.nodes[i], Vec3::Zero()).first->second += form.coefficients[i];
    return out;
  };
  const std::map<int, Vec3> x = sums(a), y = sums(b);
  return a.offset == b.offset && std::equal(x.begin(), x.end(), y.begin(), y.end(), [](auto& p, auto& q) {
           return p.first == q.first && close_to(p.second, q.second);
         });
}

}  // namespace unfurl
