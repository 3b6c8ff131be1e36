// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/turning_back.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/forces/spring.hpp"
#include "core/simulate/run_words.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {
namespace {

constexpr double at_it = 1e-9;    // of the lengths that make it up: nearer, its side is rounding
constexpr double on_axis = 1e-4;  // of a side's length: as good as along its axis
constexpr double near_it = 0.1;   // of both states' own: what passes further away has turned round otherwise

constexpr double never = std::numeric_limits<double>::quiet_NaN();

bool turns_back(const Measure& m) {
  if (m.nodes.empty()) return false;  // a force that acts on no measure
  return m.kind == MeasureKind::length || (m.kind == MeasureKind::angle && !counts_turns(m));
}

// Whether it pulls on both sides of where its measure turns back.
bool acts_through(const Force& f) {
  return f.kind == "motor" || (!f.one_sided && f.stiffness > 0);
}

// Zero where the measure turns back, pointing the other way behind: the distance itself, or the normal of an
// angle's lines. `size`: what it is to be compared with.
Vec3 side_of(const Measure& measure, const VectorXd& q, double& size) {
  const auto between = [&](std::size_t a, std::size_t b) -> Vec3 {
    return q.segment<3>(3 * measure.nodes[b]) - q.segment<3>(3 * measure.nodes[a]);
  };
  const Vec3 d1 = between(0, 1);
  if (measure.kind == MeasureKind::length) return size = 1.0, d1;
  const Vec3 d2 = between(2, 3);
  size = d1.norm() * d2.norm();
  return d1.cross(d2);
}

// How near a way from a to b comes to zero, as a part of all that lies between: 0 through it.
double nearness(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() / (b - a).squaredNorm();
}

enum class Passage { none, through, close_by };

// Through: at a tenth of both sides' own at most. Close by: at less than half of the way, turning by more
// than a right angle.
Passage passage(const Vec3& a, const Vec3& b, double size) {
  const double least = std::min(a.norm(), b.norm());
  if (!(a.dot(b) < 0) || least <= at_it * size) return Passage::none;
  return a.cross(b).norm() <= near_it * least * (b - a).norm() ? Passage::through : Passage::close_by;
}

std::string through(const std::string& name, bool angle) {
  return angle ? "the rods of " + name +
                     " pass through one line, where an angle without an axis turns back and the torque on it "
                     "jumps; give an axis, if the hinge turns through"
               : "the ends of " + name +
                     " pass each other, where its force turns round; what follows is right to the first "
                     "order of solver.step";
}

std::string held_through(const std::string& name, bool angle) {
  return angle ? "the rods of " + name +
                     " pass through one line, where an angle without an axis turns back, and with it what " +
                     name + " holds; give an axis"
               : "a length of " + name +
                     " falls to 0 and turns back, and with it what is held: end its travel before that "
                     "(kind = \"length_stop\")";
}

std::string stop_missed(const std::string& name, bool angle) {
  return angle ? "the rods of " + name +
                     " pass through one line beyond its limit, where an angle without an axis turns back: it "
                     "is not met; give an axis"
               : "the ends of " + name +
                     " pass each other beyond its limit: it is not met; take a smaller solver.step";
}

// `step`: in which it turns by some 30 degrees.
std::string close_by(const std::string& name, bool angle, double distance, double step) {
  char text[240];
  if (angle)
    std::snprintf(text, sizeof text, " pass one line at %.2g degrees",
                  std::asin(std::min(1.0, distance)) * 180 / pi);
  else
    std::snprintf(text, sizeof text, " pass each other at %.2g m", distance);
  const std::string how = text;
  std::snprintf(text, sizeof text,
                ", and what it pulls with turns round within a step, which does not resolve that; make "
                "solver.step %.2g s",
                step);
  return (angle ? "the rods of " : "the ends of ") + name + how + text;
}

}  // namespace

void TurningBack::add(Of of, std::size_t index, const std::string& name, const Measure& measure,
                      double free) {
  if (turns_back(measure)) terms_.push_back({of, index, name, measure, free});
  for (const MeasureTerm& term : measure.terms)
    if (turns_back(term.measure)) terms_.push_back({of, index, name, term.measure, never});
}

TurningBack::TurningBack(const Structure& structure) {
  std::size_t index = 0;
  for (const Force& f : structure.forces) {
    if (acts_through(f)) add(Of::force, index, f.name, f.measure, f.kind == "motor" ? never : f.rest);
    ++index;
  }
  for (const Constraint& c : structure.constraints) {
    if (c.kind == "measure") add(Of::constraint, index, c.name, c.measure, never);
    ++index;
  }
  for (const Stop& stop : structure.stops) {
    const bool lower = stop.min > 0, upper = stop.max < pi;
    if (stop.measure.kind == MeasureKind::angle ? lower || upper : lower)
      add(Of::stop, index, stop.name, stop.measure,
          stop.measure.kind != MeasureKind::angle || (lower && upper) ? never
          : lower                                                     ? pi
                                                                      : 0.0);
    ++index;
  }
  said_.assign(index, false);
}

std::vector<std::string> TurningBack::between(const System& system, const State& before, const State& after) {
  std::vector<std::string> told;
  if (terms_.empty()) return told;
  VectorXd q(system.coordinates()), later(q.size());
  system.expand(before.z, q);
  system.expand(after.z, later);
  for (const Term& term : terms_) {
    if (said_[term.index]) continue;
    double size = 0;
    const Vec3 side = side_of(term.measure, q, size);
    const Vec3 there = side_of(term.measure, later, size);
    const Passage how = passage(side, there, size);
    if (how == Passage::none || (term.of != Of::force && how == Passage::close_by)) continue;
    const bool angle = term.measure.kind == MeasureKind::angle;
    const double value = MeasureFunction(term.measure, {}).value(later.data());
    const double turn = angle && value > pi / 2 ? pi : 0.0;
    if (std::abs(turn - term.free) <= at_it) continue;
    said_[term.index] = true;
    told.push_back("at t = " + seconds(after.t) + ": " +
                   (term.of == Of::constraint ? held_through(term.name, angle)
                    : term.of == Of::stop     ? stop_missed(term.name, angle)
                    : how == Passage::through
                        ? through(term.name, angle)
                        : close_by(term.name, angle, nearness(side, there) * (there - side).norm() / size,
                                   0.5 * nearness(side, there) * (after.t - before.t))));
  }
  return told;
}

namespace {

// What of an angle about an axis or an edge can come to lie along that, where there is no such angle.
struct AxisSide {
  int from, to;  // nodes
  Vec3 across;   // its part across the axis
  double length;
};
std::vector<AxisSide> axis_sides(const Measure& m, const VectorXd& q) {
  const bool edge = m.kind == MeasureKind::dihedral;
  if (m.nodes.size() != 4 || !(edge || (m.kind == MeasureKind::angle && counts_turns(m)))) return {};
  const auto between = [&](int a, int b) -> Vec3 { return q.segment<3>(3 * b) - q.segment<3>(3 * a); };
  const Vec3 axis = (edge ? between(m.nodes[1], m.nodes[2]) : m.axis).normalized();
  std::vector<AxisSide> out;
  for (const auto& [from, to] :
       {std::pair{m.nodes[edge ? 1 : 0], m.nodes[edge ? 0 : 1]}, std::pair{m.nodes[2], m.nodes[3]}}) {
    const Vec3 side = between(from, to);
    out.push_back({from, to, side - side.dot(axis) * axis, side.norm()});
  }
  return out;
}

// That a way from q to `later` leads a side onto its axis, or past it at a tenth of its distance before.
std::string onto_its_axis(const Structure& structure, const std::string& name, const Measure& measure,
                          const VectorXd& q, const VectorXd& later) {
  const std::vector<AxisSide> now = axis_sides(measure, q), then = axis_sides(measure, later);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec3 here = now[i].across, way = then[i].across - here;
    const double part = std::clamp(-here.dot(way) / way.squaredNorm(), 0.0, 1.0);
    if (here.norm() > on_axis * now[i].length && !((here + part * way).norm() <= near_it * here.norm()))
      continue;
    const auto node = [&](int n) { return structure.nodes[static_cast<std::size_t>(n)].name; };
    const bool edge = measure.kind == MeasureKind::dihedral;
    return (edge ? node(now[i].to) + " comes onto the edge of " + name + ", "
                 : node(now[i].from) + "-" + node(now[i].to) + " comes to lie along the axis of " + name +
                       ", ") +
           "about which it has no angle there to be held: end the motion before that (a stop), or hold it " +
           (edge ? "by other nodes" : "about another axis");
  }
  return "";
}

// That a winch may wind up all of an elastic cable within two steps: what is left of it off the drum gets as
// stiff as there is force.
bool winds_up(const Force& cable, double t, double h, const VectorXd& q, const VectorXd& v) {
  const SpringLaw law = spring_law(cable, t, q.data());
  return law.drum >= 0 && !(cable.axial_stiffness / law.stiffness - 2 * h * v[law.drum] > at_it);
}

}  // namespace

std::string at_its_end(const Structure& structure, const System& system, const State& state, double h) {
  VectorXd q(system.coordinates()), v(q.size());
  system.expand(state.z, q);
  system.expand_rate(state.w, v);
  const auto ends = [&](const Measure& measure) {
    if (!turns_back(measure)) return false;
    const MeasureFunction function(measure, {});
    std::vector<double> gradient(function.stencil().size());
    const double value = function.value_and_gradient(q.data(), gradient.data()),
                 there = value + 2 * h * function.rate(gradient.data(), v.data());
    return !(there > at_it) || (measure.kind == MeasureKind::angle && !(there < pi - at_it));
  };
  const VectorXd later = q + 2 * h * v;
  const auto ended = [&](const Constraint& c, const Measure& measure) {
    return ends(measure) ? held_through(c.name, is_angle(measure))
                         : onto_its_axis(structure, c.name, measure, q, later);
  };
  for (const Constraint& c : structure.constraints) {
    if (c.kind != "measure") continue;
    if (std::string words = ended(c, c.measure); !words.empty()) return words;
    for (const MeasureTerm& term : c.measure.terms)
      if (std::string words = ended(c, term.measure); !words.empty()) return words;
  }
  for (const Force& f : structure.forces) {
    if (winds_up(f, state.t, h, q, v)) return held_through(f.name, false);
    if (f.measure.kind == MeasureKind::angle && acts_through(f) && ends(f.measure))
      return "the rods of " + f.name +
             " come to lie in line, where an angle without an axis turns back and the torque on it jumps: "
             "give "
             "it an axis, or make solver.step smaller";
  }
  return "";
}

}  // namespace unfurl
