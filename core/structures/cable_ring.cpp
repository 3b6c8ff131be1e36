// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/cable_ring.hpp"

#include <cmath>
#include <limits>

#include "core/structure/measure.hpp"
#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {
namespace {

struct CableRingShape {
  int n = 0;
  double longeron = 0, batten = 0, fold = 0, deployed = 0;

  int bottom(int k) const { return 2 * (k % n); }
  int top(int k) const { return bottom(k) + 1; }
  double angle(int k) const { return 2 * pi * k / n; }
  // Battens that go up as the ring folds: +1.
  double side(int k) const { return k % 2 == 0 ? -1.0 : 1.0; }
  double radius(double at) const { return longeron * std::cos(at) / (2 * std::sin(pi / n)); }
};

CableRingShape shape_of(const ParamSet& params) {
  CableRingShape s;
  s.n = static_cast<int>(params.integer("units"));
  if (s.n % 2 != 0)
    throw StructureError("units", "must be even: battens go up and down in turn; got " + std::to_string(s.n));
  s.longeron = params.real("longeron_length");
  s.batten = params.real("post_length");
  s.fold = params.real("fold_angle") * radians_per_degree;
  s.deployed = params.real("deployed_angle") * radians_per_degree;
  require_unfolding(params.real("fold_angle"), params.real("deployed_angle"));
  return s;
}

void add_bays(Assembly& a, const CableRingShape& s, const ParamSet& params) {
  const RodSection section = rod_section(params);
  const double diagonal = 0.25 * params.real("diagonal_mass");  // a bay's on its four corners: two bays each
  for (int k = 0; k < s.n; ++k) {
    const Vec3 foot = s.radius(s.fold) * radial(s.angle(k)) +
                      0.5 * (s.side(k) * s.longeron * std::sin(s.fold) - s.batten) * Vec3::UnitZ();
    a.node("B" + std::to_string(k), foot, 2 * diagonal);
    a.node("T" + std::to_string(k), foot + s.batten * Vec3::UnitZ(), 2 * diagonal);
  }
  for (int k = 0; k < s.n; ++k) {
    a.rod(s.bottom(k), s.top(k), s.batten, section.mass_per_length * s.batten, "post", section.radius);
    for (const int level : {0, 1})
      a.rod(s.bottom(k) + level, s.bottom(k + 1) + level, s.longeron, section.mass_per_length * s.longeron,
            "longeron", section.radius);
  }
}

// Viscous joints, at both ends of each of the 2 n longerons: without what resists it the ring would run ahead
// of a cable that can only pull.
void add_dampers(Assembly& a, const CableRingShape& s, double damping) {
  for (int k = 0; damping > 0 && k < s.n; ++k)
    for (const int level : {0, 1})
      for (const int other : {(k + s.n - 1) % s.n, (k + 1) % s.n}) {
        const int here = s.bottom(k) + level, opposite = s.bottom(k) + 1 - level;
        Force joint;
        joint.kind = "torsion_spring";
        joint.name = "joint at " + a.name(here);
        joint.measure.kind = MeasureKind::angle;
        joint.measure.nodes = {here, opposite, here, s.bottom(other) + level};
        joint.damping = damping;
        a.structure.forces.push_back(std::move(joint));
      }
}

void hold(Assembly& a, std::string name, const Measure& measure, double value) {
  TimeFunction target;
  target.offset = value;
  a.structure.constraints.push_back({"measure", std::move(name), {}, {}, 0.0, measure, target});
}

Measure angle_between(const CableRingShape& s, int k, int other) {
  Measure m;
  m.kind = MeasureKind::angle;
  m.nodes = {s.bottom(k), s.top(k), s.bottom(k), s.bottom(other)};
  return m;
}

void add_joints(Assembly& a, const CableRingShape& s, bool gears) {
  for (int k = 0; k < s.n; ++k) {
    const std::string i = std::to_string(k);
    const int before = (k + s.n - 1) % s.n;
    if (k > 0)
      for (int c = 0; c < 3; ++c) {
        const Vec3 e = Vec3::Unit(c);
        a.relation("post B" + i + "-T" + i + " parallel to B0-T0 " + "xyz" [c],
                   { s.bottom(k), s.top(k), 0, 1 }, {-e, e, e, -e});
      }
    Measure turn;
    turn.kind = MeasureKind::dihedral;
    turn.nodes = {s.bottom(before), s.bottom(k), s.top(k), s.bottom(k + 1)};
    turn.reference = -pi + 2 * pi / s.n;  // from the bay before, round the outside, to the next one
    hold(a, "bays at post B" + i + "-T" + i, turn, turn.reference);
    if (!gears) continue;
    Measure mesh;
    mesh.kind = MeasureKind::combination;
    mesh.terms = {{1.0, angle_between(s, k, before)}, {-1.0, angle_between(s, k, k + 1)}};
    hold(a, "gear at B" + i, mesh, 0.0);
  }
}

// One cable through all diagonals, from B0 over T1, B2, ... back to B0.
void add_cable(Assembly& a, const CableRingShape& s, const ParamSet& params) {
  Measure path;
  path.kind = MeasureKind::combination;
  for (int k = 0; k < s.n; ++k) {
    MeasureTerm span;
    span.measure.nodes = {k % 2 == 0 ? s.bottom(k) : s.top(k), k % 2 == 0 ? s.top(k + 1) : s.bottom(k + 1)};
    path.terms.push_back(span);
  }
  Stop cable{.name = "cable", .measure = path};
  const double l = s.longeron, h = s.batten;
  cable.reeled = true;
  cable.reel.offset = s.n * std::sqrt(l * l + h * h + 2 * h * l * std::sin(s.fold));
  if (const double rate = params.real("cable_rate"); rate > 0) {
    cable.reel.kind = TimeFunction::Kind::rate;
    cable.reel.rate = -rate;
    cable.reel.ramp = params.real("cable_ramp");
  }
  a.structure.stops.push_back(std::move(cable));
}

// Means over the bays: how far one batten is above the other, how far beside it.
void set_deployment(Assembly& a, const CableRingShape& s) {
  Deployment& d = a.structure.deployment;
  const double share = 1 / (s.n * s.longeron);
  for (int k = 0; k < s.n; ++k) {
    d.fold_sine.nodes.push_back(s.bottom(k));
    d.fold_sine.coefficients.push_back(2 * s.side(k) * share * Vec3::UnitZ());
    const Vec3 along = share * tangential(s.angle(k) + pi / s.n);
    for (const int end : {0, 1}) {
      d.fold_cosine.nodes.push_back(s.bottom(k + end));
      d.fold_cosine.coefficients.push_back(end == 0 ? Vec3(-along) : along);
    }
    d.latches.push_back({{s.bottom(k), s.bottom(k + 1)},
                         {-s.side(k + 1) * Vec3::UnitZ(), s.side(k + 1) * Vec3::UnitZ()},
                         -s.longeron * std::sin(s.deployed)});
  }
  d.initial_fold_angle = s.fold;
  d.deployed_fold_angle = s.deployed;
}

}  // namespace

const std::vector<ParamSpec>& cable_ring_params() {
  static const std::vector<ParamSpec> params{
      integer_param("units", 12, 4, 10000, "number of bays around the ring, even"),
      positive_param("longeron_length", "m", 1.6, "length of a longeron, the chord of a bay"),
      positive_param("post_length", "m", 0.9, "length of a batten, the height of the ring"),
      positive_param("density", "kg/m^3", 1600.0, "density of the rods"),
      positive_param("section_area", "m^2", 2e-4, "cross section of the rods"),
      inside(real_param("fold_angle", "deg", 80.0, 0.0, 90.0, "of the longerons at t = 0; 0 is level")),
      below_max(real_param("deployed_angle", "deg", 0.0, 0.0, 90.0, "of the longerons when deployed")),
      real_param("cable_rate", "m/s", 0.5, 0.0, std::numeric_limits<double>::infinity(),
                 "at which the cable through the diagonals is drawn in; 0: it is held"),
      only_given("cable_rate",
                 real_param("cable_ramp", "s", 2.0, 0.0, std::numeric_limits<double>::infinity(),
                            "how long the cable takes to reach that")),
      real_param("diagonal_mass", "kg", 0.1, 0.0, std::numeric_limits<double>::infinity(),
                 "of a telescoping diagonal, shared by the corners of its bay"),
      real_param("joint_damping", "N m s/rad", 1.0, 0.0, std::numeric_limits<double>::infinity(),
                 "of every longeron at either of its battens: the cable can only pull, and the ring would "
                 "run ahead of it"),
      boolean_param("gears", true, "synchronising gears at the battens: all bays turn alike"),
      choice_param("mass", "consistent", {"consistent", "lumped"}, "mass matrix of a rod"),
  };
  return params;
}

Structure build_cable_ring(const ParamSet& params) {
  const CableRingShape s = shape_of(params);
  Assembly a;
  add_bays(a, s, params);
  add_joints(a, s, params.boolean("gears"));
  add_dampers(a, s, params.real("joint_damping"));
  add_cable(a, s, params);
  set_deployment(a, s);
  a.structure.kind = "cable_ring";
  a.structure.lumped_mass = params.text("mass") == "lumped";
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
