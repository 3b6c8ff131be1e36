// SPDX-License-Identifier: BSD-3-Clause
// [[forces]] of a scene into a structure: the kinds are those of the force table (forces/force.hpp).
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/forces/motor.hpp"
#include "core/forces/spring.hpp"
#include "core/scene/element_members.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/structure_error.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

const ForceKind& force_kind(std::string_view kind) {
  for (const ForceKind& row : force_kinds())
    if (row.kind == kind) return row;
  throw std::logic_error("no force kind " + std::string(kind));
}

// What all forces of an entry have in common, once for each node or other member that it names.
std::vector<Force> forces_on(const SceneElement& e, Members members, MemberFinder& find) {
  Force one;
  one.kind = e.kind;
  one.name = e.name;
  std::vector<Force> forces;
  const auto measured = [&](const std::optional<Measure>& measure) {
    if (!measure) return;
    one.measure = *measure;
    one.rest = find.initial(*measure);
    forces.push_back(one);
  };
  switch (members) {
    case Members::none:
      forces.push_back(one);
      break;
    case Members::each_node:
      // What carries each node's own weight is meant for those within rods, too, which have their share of
      // it.
      for (const int node : e.kind == "offload" ? find.nodes(e, true) : find.nodes_outside_rods(e)) {
        forces.push_back(one);
        forces.back().nodes = {node};
      }
      break;
    case Members::node_list:
      one.nodes = find.nodes_outside_rods(e);
      if (!one.nodes.empty()) forces.push_back(one);
      break;
    case Members::three_nodes:
      one.nodes = find.nodes(e, false);
      if (one.nodes.size() == 3 && find.apart(e, "nodes", one.nodes[0], one.nodes[1]) &&
          find.apart(e, "nodes", one.nodes[1], one.nodes[2]))
        forces.push_back(one);
      break;
    case Members::rods:
      break;
    case Members::rod:
      if (const auto rod = find.rod(e, 0); rod.first) {
        one.nodes = {rod.last->a, rod.last->b};
        if (rod.first != rod.last) one.nodes.push_back((rod.last - 1)->a);
        forces.push_back(one);
      }
      break;
    case Members::two_nodes:
      measured(length_of(e, find));
      break;
    case Members::path:
      measured(path_of(e, find));
      break;
    case Members::terms:
      measured(terms_of(e, find));
      break;
    case Members::angle:
      measured(angle_of(e, find));
      break;
    case Members::measure:
      measured(measure_of(e, find));
      break;
  }
  return forces;
}

// The least change of a warmed rod's length, of its length: of a table at its points and where its spline
// turns between them, the roots of f' = d_0 + B u + A u^2 on an interval.
double shortest_share(const Force& warming) {
  const TimeFunction& f = warming.size;
  double least = warming.expansion * f(f.times.empty() ? 0.0 : f.times.front());
  const auto look = [&](double t) { least = std::min(least, warming.expansion * f(t)); };
  for (std::size_t i = 0; i + 1 < f.times.size(); ++i) {
    const double begin = f.times[i], h = f.times[i + 1] - begin;
    look(begin + h);
    const double d0 = f.derivative(1, begin), d1 = f.derivative(1, begin + h),
                 middle = f.derivative(1, begin + 0.5 * h);
    const double A = 2 * (d0 + d1 - 2 * middle), B = 4 * middle - 3 * d0 - d1;
    const double q = -0.5 * (B + std::copysign(std::sqrt(std::max(0.0, B * B - 4 * A * d0)), B));
    for (const double u : {q / A, d0 / q})
      if (u > 0 && u < 1) look(begin + u * h);
  }
  return least;
}

// What an entry says of rods becomes theirs.
void warm_rods(const SceneElement& e, const ForceKind& kind, ElementAdder& to) {
  Force warming;
  kind.fill(e.values, warming);
  for (const int r : to.find.rods(e)) {
    Rod& rod = to.structure.rods[static_cast<std::size_t>(r)];
    if (rod.expansion != 0)
      return to.find.problem(e, "rods",
                             "names " + in_quotes(rod.name) + ", which another entry warms already");
    if (!(1 + shortest_share(warming) > 0)) {
      const char* key = e.values.vector("times").empty() ? "change" : e.table.empty() ? "values" : "table";
      return to.find.problem(
          e, key,
          "shrinks " + in_quotes(rod.name) + " to nothing: expansion times the change must stay above -1");
    }
    rod.expansion = warming.expansion;
    rod.warming = warming.size;
  }
}

// The rotor and the controller's integral of the motor that is the structure's last force.
void add_ghosts(ElementAdder& to, double inertia, double initial) {
  const Motor& motor = to.structure.forces.back().motor;
  if (motor.control == Motor::Control::position && motor.integral > 0) add_integrator(to.structure, initial);
  if (inertia > 0) add_rotor(to.structure, inertia, initial);
}

void add_force(const SceneElement& e, ElementAdder& to) {
  const ForceKind& kind = force_kind(e.kind);
  if (kind.members == Members::rods) return warm_rods(e, kind, to);
  if (e.kind == "offload" && to.structure.gravity.isZero(0.0))
    to.structure.notes.push_back(
        problem_text({{}, e.key, "does nothing without a weight: gravity.acceleration is 0"}));
  for (Force& force : forces_on(e, kind.members, to.find)) {
    if (e.kind == "offload" && std::ranges::any_of(to.structure.forces, [&](const Force& other) {
          return other.kind == "offload" && other.nodes == force.nodes;
        }))
      return to.find.problem(
          e, "nodes",
          "names " + in_quotes(to.structure.nodes[static_cast<std::size_t>(force.nodes[0])].name) +
              ", which hangs on the rope of another entry already, with its whole weight");
    const double begin = force.rest;
    try {
      kind.fill(e.values, force);
    } catch (const StructureError& error) {
      return to.find.problem(e, error.key, error.message);
    }
    if (e.kind == "combination" && force.stiffness > 0)
      note_long_way(e, "free_value", force.measure, begin, force.rest, to.structure);
    const double initial = force.rest;
    to.structure.forces.push_back(std::move(force));
    if (kind.kind == "motor") add_ghosts(to, e.values.real("inertia"), initial);
  }
}

// Friction on what a cable runs over needs its tension, and something to run over. False: a problem was
// noted.
bool check_pulleys(const SceneElement& e, ElementAdder& to, double axial_stiffness, std::size_t spans) {
  if (!(e.values.real("pulley_friction") > 0)) return true;
  if (spans < 2)
    to.find.problem(e, "pulley_friction", "does nothing for a cable of two nodes: it runs over none");
  else if (!(axial_stiffness > 0))
    to.find.problem(e, "pulley_friction", "needs a cable that stretches; give axial_stiffness");
  else
    return true;
  return false;
}

}  // namespace

// A drum, a ghost whose coordinate x is what it has drawn in: the cable's measure is its path and x.
void add_winch(const SceneElement& e, ElementAdder& to) {
  auto measure = path_of(e, to.find);
  if (!measure) return;
  const ParamSet& v = e.values;
  const double path = to.find.initial(*measure), radius = v.real("drum_radius");
  Force motor;
  motor.kind = "motor";
  motor.name = e.name;
  motor.measure.kind = MeasureKind::coordinate;
  motor.measure.axis = Vec3::UnitX();
  try {
    fill_motor(v, motor);
  } catch (const StructureError& error) {
    return to.find.problem(e, error.key, error.message);
  }
  const double length = std::isnan(v.real("length")) ? path : v.real("length"),
               ea = v.real("axial_stiffness");
  if (!(ea > 0) && length < path - to.find.same(*measure, path))
    return to.find.problem(e, "length",
                           "is shorter than the path of the cable at t = 0; give axial_stiffness");
  if (!(ea > 0) && v.real("damping") > 0)
    return to.find.problem(e, "damping",
                           "does nothing for a cable that does not stretch; give axial_stiffness");
  if (!check_pulleys(e, to, ea, measure->terms.size())) return;
  const double n = motor.motor.gear_ratio;
  const int drum =
      add_ghost(to.structure, "drum of " + e.name, n * n * v.real("inertia") / (radius * radius), 0.0);
  motor.measure.nodes = {drum};
  motor.motor.gear_ratio = n / radius;
  measure->terms.push_back({1.0, motor.measure});
  to.structure.forces.push_back(std::move(motor));
  add_ghosts(to, 0.0, 0.0);
  TimeFunction limit;
  limit.offset = length;
  if (ea > 0) {
    Force cable;
    cable.kind = "cable";
    cable.name = e.name + " cable";
    cable.measure = *measure;
    cable.axial_stiffness = ea;
    cable.damping = v.real("damping");
    fill_pulleys(v, cable);
    cable.one_sided = true;
    cable.rest = length;
    cable.unstressed = limit;
    return to.structure.forces.push_back(std::move(cable));
  }
  Stop stop{.name = e.name + " cable", .measure = *measure};
  stop.reel = limit;
  stop.reeled = true;
  to.structure.stops.push_back(std::move(stop));
}

// What does not stretch is a stop that moves: the path is at most as long as the cable.
void add_cable(const SceneElement& e, ElementAdder& to) {
  const auto measure = path_of(e, to.find);
  if (!measure) return;
  const double path = to.find.initial(*measure);
  Force cable;
  cable.kind = "cable";
  cable.name = e.name;
  cable.measure = *measure;
  cable.rest = path;
  force_kind("cable").fill(e.values, cable);
  cable.unstressed = motion_of(e, to, *measure, cable.rest);
  if (!check_pulleys(e, to, cable.axial_stiffness, measure->terms.size())) return;
  if (cable.axial_stiffness > 0) {
    to.structure.forces.push_back(std::move(cable));
    return;
  }
  if (cable.rest < path - to.find.same(*measure, path)) {
    std::ostringstream text;
    text.precision(15);  // a number to be given
    text << "is shorter than the path of the cable at t = 0, which is " << path
         << " m; give axial_stiffness, so that it can stretch, or at least that length";
    return to.find.problem(e, "length", text.str());
  }
  for (const char* key : {"damping", "smoothing"})
    if (e.values.real(key) > 0)
      to.find.problem(e, key, "does nothing for a cable that does not stretch; give axial_stiffness");
  Stop stop{.name = e.name, .measure = *measure};
  stop.reel = std::move(cable.unstressed);
  stop.reeled = true;
  to.structure.stops.push_back(std::move(stop));
}

const std::vector<ElementKind>& scene_forces() {
  static const std::vector<ElementKind> kinds = [] {
    std::vector<ElementKind> found;
    for (const ForceKind& row : force_kinds())
      if (row.params)
        found.push_back({row.kind, row.help, row.members, row.params,
                         row.kind == "cable" ? add_cable : add_force,
                         row.members == Members::two_nodes ? length_of
                         : row.members == Members::path    ? path_of
                         : row.members == Members::terms   ? terms_of
                         : row.members == Members::angle   ? angle_of
                         : row.members == Members::measure ? measure_of
                                                           : nullptr});
    found.push_back({"winch", "a motor with a drum that draws in a cable over nodes in order", Members::path,
                     winch_params, add_winch, path_of});
    return found;
  }();
  return kinds;
}

}  // namespace unfurl
