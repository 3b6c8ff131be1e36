// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/constraints/constraint.hpp"
#include "core/constraints/linear_rows.hpp"
#include "core/forces/latch_spring.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {
namespace {

constexpr std::array known_forces{"load",   "gravity", "load_over_time", "follower",
                                  "spring", "latch",   "torsion_spring", "motor",
                                  "drag",   "offload", "joint_damping",  "friction"};
constexpr std::array known_constraints{"plane",   "line",      "fixed",    "relation",
                                       "measure", "collinear", "coplanar", "rod"};
constexpr std::array known_measures{MeasureKind::coordinate, MeasureKind::length, MeasureKind::angle,
                                    MeasureKind::fold};

template <class List, class Kind>
bool holds(const List& list, const Kind& kind) {
  return std::find(list.begin(), list.end(), kind) != list.end();
}

// The structure without anything that acts on it.
Structure bare(const Structure& structure) {
  Structure out = structure;
  out.loads.clear();
  out.forces.clear();
  out.constraints.clear();
  out.stops.clear();
  out.node_copies.clear();
  out.rod_copies.clear();
  out.load_copies.clear();
  out.gravity.setZero();
  return out;
}

// A motor's effort is linear in its speed at full voltage, and only there.
std::string unknown_motor(const Force& force) {
  if (force.kind != "motor") return "";
  if (force.motor.control != Motor::Control::none) return "a controller follows a motion";
  if (std::isfinite(force.motor.limit)) return "the current of a motor is limited";
  return force.motor.command.moves() ? "the voltage of a motor changes with time" : "";
}

bool is_cable(const Force& force) {
  return force.one_sided && (force.stiffness > 0 || force.damping > 0);
}

bool has_no_axis(const Measure& measure) {
  return (measure.kind == MeasureKind::angle && measure.axis.isZero(0.0)) ||
         std::ranges::any_of(measure.terms,
                             [](const MeasureTerm& term) { return has_no_axis(term.measure); });
}

// "sync" holds ...: what of it the path does not know.
std::string unknown_measure(const std::string& name, const char* acts, const Measure& measure) {
  if (holds(known_measures, measure.kind)) return "";
  return in_quotes(name) + " " + acts + " " +
         (measure.kind == MeasureKind::dihedral ? "an angle between planes"
                                                : "a sum of measures (as gears, racks and cables do)") +
         ", which is not known to the path: coordinates, lengths, angles and the fold angle are";
}

// So fast that forces at rest are below the rounding of what dampers give; products with it are exact.
constexpr double no_rest = 0x1p100;  // [m kg^1/2 / s]

}  // namespace

std::string unknown_to_path(const Structure& structure) {
  const auto kinds = [](std::string_view what, std::string_view kind) {
    return std::string(what) + " of the kind \"" + std::string(kind) + "\" is not known to the path";
  };
  for (const Force& force : structure.forces) {
    if (force.kind == "friction" && force.size.offset > 0) return "friction depends on the force of a pin";
    if (force.smoothing > 0) return "a cable begins to pull smoothly";
    if (!holds(known_forces, force.kind)) return kinds("a force", force.kind);
    if (std::string motor = unknown_motor(force); !motor.empty()) return motor;
    if (std::string why = unknown_measure(force.name, "acts on", force.measure); !why.empty()) return why;
  }
  for (const Constraint& constraint : structure.constraints) {
    if (!holds(known_constraints, constraint.kind)) return kinds("a constraint", constraint.kind);
    if (std::string why = unknown_measure(constraint.name, "holds", constraint.measure); !why.empty())
      return why;
  }
  for (const Stop& stop : structure.stops)
    if (stop.reeled) return "a cable that does not stretch is not known to the path";
  for (const Stop& stop : structure.stops)
    if (std::string why = unknown_measure(stop.name, "bounds", stop.measure); !why.empty()) return why;
  // Kinds that are made of something else than the structure's lists.
  SparseRows mass(3 * std::ssize(structure.nodes), 3 * std::ssize(structure.nodes));
  for (const ForceKind& kind : force_kinds())
    if (!holds(known_forces, kind.kind) && kind.make(structure, mass)) return kinds("a force", kind.kind);
  for (const ConstraintKind& kind : constraint_kinds())
    if (!holds(known_constraints, kind.kind) && kind.make(structure)) return kinds("a constraint", kind.kind);
  return "";
}

PathForces::PathForces(const Structure& structure, const Path& path, bool separately)
    : structure_(structure), length_(reference_length(structure)) {
  const System& system = path.system();
  Structure one = bare(structure);
  columns_ = separately ? 0 : 2;  // what all have in common: position, damping
  const auto add = [&](const std::string& name, std::string_view kind, const TimeFunction* size, bool cable) {
    Source source{name, std::string(kind)};
    source.timed = size != nullptr;
    if (size) source.size = *size;
    const bool own = separately || size || cable || kind == "friction";
    source.turns_back =
        std::ranges::any_of(one.forces, [](const Force& force) { return has_no_axis(force.measure); });
    source.position = own ? columns_++ : 0;
    source.damping = own ? columns_++ : 1;
    if (cable) {
      const Force& f = one.forces.front();
      source.cable = static_cast<int>(cables_.size());
      cables_.push_back({f.name, add_measure(f.measure), f.rest, f.stiffness, f.damping});
    }
    if (kind == "friction") {
      Force& f = one.forces.front();
      source.friction = static_cast<int>(frictions_.size());
      frictions_.push_back({f.name, f.kinetic, f.holding});
      f.slip = 1;  // of a unit; the block gives its force against ds
      f.kinetic = 1;
    }
    add_term(one, kind, source, system);
    sources_.push_back(std::move(source));
  };
  one.loads = structure.loads;
  if (!one.loads.empty()) add("loads", "load", nullptr, false);
  one.loads.clear();
  one.gravity = structure.gravity;
  // It stays: what an offload carries is weight. The blocks of other kinds do not look at it.
  if (!one.gravity.isZero(0.0)) add("gravity", "gravity", nullptr, false);
  std::vector<char> done(structure.forces.size(), 0);
  for (std::size_t i = 0; i < structure.forces.size(); ++i) {
    const Force& force = structure.forces[i];
    if (done[i] || latch_waits(force)) continue;
    if (force.kind == "friction" && !(force.holding > 0)) continue;
    one.forces = {force};
    const bool timed = force.size.moves();
    if (timed) {
      TimeFunction unit;
      unit.offset = 1;
      one.forces[0].size = unit;
    } else if (is_cable(force)) {
      one.forces[0].one_sided = false;  // as it is while it pulls
    } else if (force.kind != "friction") {
      for (std::size_t k = i + 1; k < structure.forces.size(); ++k) {
        const Force& other = structure.forces[k];
        if (other.kind != force.kind || other.size.moves() || is_cable(other) ||
            (separately && other.name != force.name) || latch_waits(other))
          continue;
        one.forces.push_back(other);
        done[k] = 1;
      }
    }
    if (force.kind == "joint_damping") one.constraints = structure.constraints;  // which hold pins on rods
    add(force.name, force.kind, timed ? &force.size : nullptr, is_cable(force));
    one.constraints.clear();
  }
}

void PathForces::add_term(const Structure& one, std::string_view kind, const Source& source,
                          const System& system) {
  Term term;
  for (const ForceKind& row : force_kinds())
    if (row.kind == kind) term.block = row.make(one, system.node_mass());
  if (!term.block) return;
  term.position = source.position;
  term.damping = source.damping;
  if (term.block->constant()) {
    const VectorXd nowhere = VectorXd::Zero(system.coordinates());
    term.constant = nowhere;
    term.block->add(0.0, nowhere.data(), nowhere.data(), 1.0, term.constant.data());
  }
  term.first_angle = angle_count_;
  for (const Measure& measure : followed_angles(one).measures)
    term.angles.emplace_back(measure, one.deployment);
  angle_count_ += std::ssize(term.angles);
  terms_.push_back(std::move(term));
}

Index PathForces::add_measure(const Measure& measure) {
  Tracked tracked{MeasureFunction(measure, structure_.deployment), columns_++};
  if (counts_turns(measure)) tracked.angle = angle_count_++;
  measures_.push_back(std::move(tracked));
  return measures_.back().column;
}

Index PathForces::add_remaining() {
  remaining_angles_ = angle_count_;
  angle_count_ += structure_.deployment.first_angles().size();
  remaining_ = columns_;
  columns_ += structure_.deployment.measured ? 1 : 2;
  return remaining_;
}

VectorXd PathForces::first_angles() const {
  VectorXd angles(angle_count_);
  for (const Term& term : terms_)
    for (std::size_t i = 0; i < term.angles.size(); ++i)
      angles[term.first_angle + static_cast<Index>(i)] = term.angles[i].reference();
  for (const Tracked& tracked : measures_)
    if (tracked.angle >= 0) angles[tracked.angle] = tracked.measure.reference();
  if (remaining_ >= 0) {
    const VectorXd own = structure_.deployment.first_angles();
    angles.segment(remaining_angles_, own.size()) = own;
  }
  return angles;
}

std::string PathForces::whose(Index column) const {
  const auto acts = [&](const Source& source) {
    return source.position == column || source.damping == column;
  };
  const auto found = std::ranges::find_if(sources_, acts);
  // Where several act by one sum it may be any of them.
  return std::ranges::count_if(sources_, acts) != 1 || !found->turns_back
             ? ""
             : ": the angle that " + in_quotes(found->name) +
                   " acts on turns back where its sides lie in line; give it an axis";
}

void PathForces::evaluate(const VectorXd& q, const VectorXd& dq, VectorXd& angles, VectorXd& value,
                          VectorXd& scale) const {
  value.setZero();
  scale.setConstant(std::numeric_limits<double>::min());
  const VectorXd at_rest = VectorXd::Zero(q.size()), no_rates = VectorXd::Zero(angles.size());
  VectorXd f(q.size()), moving(q.size());
  for (const Term& term : terms_) {
    if (term.constant.size() > 0) {
      value[term.position] += term.constant.dot(dq);
      scale[term.position] += term.constant.cwiseAbs().dot(dq.cwiseAbs());
      continue;
    }
    for (std::size_t i = 0; i < term.angles.size(); ++i) {
      double& angle = angles[term.first_angle + static_cast<Index>(i)];
      angle = term.angles[i].value(q.data(), angle);
    }
    Moment at(0.0);
    at.angles = angles.data() + term.first_angle;
    at.rates = no_rates.data();
    f.setZero();
    term.block->add(at, q.data(), at_rest.data(), 1.0, f.data());
    value[term.position] += f.dot(dq);
    scale[term.position] += f.cwiseAbs().dot(dq.cwiseAbs());
    if (!term.block->has_power()) continue;
    moving.setZero();
    term.block->add(at, q.data(), VectorXd(no_rest * dq).data(), 1.0, moving.data());
    value[term.damping] += (f - moving).dot(dq) / no_rest;
    scale[term.damping] += (f.cwiseAbs() + moving.cwiseAbs()).dot(dq.cwiseAbs()) / no_rest;
  }
  for (const Tracked& tracked : measures_) {
    const double near = tracked.angle >= 0 ? angles[tracked.angle] : tracked.measure.reference();
    value[tracked.column] = tracked.measure.value(q.data(), near);
    if (tracked.angle >= 0) angles[tracked.angle] = value[tracked.column];
    scale[tracked.column] = tracked.measure.is_angle() ? pi : length_;
  }
  if (remaining_ < 0) return;
  VectorXd own = angles.segment(remaining_angles_, structure_.deployment.first_angles().size());
  structure_.deployment.count_on(q, own);
  angles.segment(remaining_angles_, own.size()) = own;
  const Deployment& d = structure_.deployment;
  scale[remaining_] = 1.0;
  if (d.measured) {
    value[remaining_] = d.remaining(q, own);
    return;
  }
  const double c = std::cos(d.deployed_fold_angle), s = std::sin(d.deployed_fold_angle),
               sine = d.fold_sine(q), cosine = d.fold_cosine(q);
  value[remaining_] = c * sine - s * cosine;
  value[remaining_ + 1] = c * cosine + s * sine;
  scale[remaining_ + 1] = 1.0;
}

}  // namespace unfurl
