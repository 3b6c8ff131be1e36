// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/scissor_mast.hpp"

#include <cmath>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {

namespace {

struct MastShape {
  int cells, sides;
  double l, sine, cosine;  // rod length; of the fold angle
  double tip_mass, tip_force;
  RodSection section;

  bool planar() const { return sides == 1; }
  int corners() const { return planar() ? 2 : sides; }
  double side() const { return l * sine; }
  double radius() const { return side() / (2.0 * std::sin(pi / sides)); }
  Vec3 direction(int k) const { return radial(2.0 * pi * k / sides); }
  Vec3 at(int k, int level) const {
    const Vec3 height = level * l * cosine * Vec3::UnitZ();
    return planar() ? Vec3(height + k * side() * Vec3::UnitX()) : Vec3(height + radius() * direction(k));
  }
  std::string letter(int k) const {
    return planar() ? (k == 0 ? "L" : "R") : std::string(1, static_cast<char>('A' + k));
  }
};

MastShape mast_shape(const ParamSet& p) {
  MastShape s{};
  s.cells = static_cast<int>(p.integer("cells"));
  s.sides = static_cast<int>(p.integer("sides"));
  if (s.sides == 2)
    throw StructureError("sides",
                         "a mast has 1 side (planar) or 3 and more; two faces cannot enclose a mast");
  const double fold = p.real("fold_angle"), deployed = p.real("deployed_angle");
  require_unfolding(fold, deployed);
  s.l = p.real("rod_length");
  s.sine = std::sin(fold * radians_per_degree);
  s.cosine = std::sin((90.0 - fold) * radians_per_degree);  // keeps its digits near 90 degrees
  s.tip_mass = p.real("tip_mass");
  s.tip_force = p.real("tip_force");
  s.section = rod_section(p);
  return s;
}

// Node of corner k on a level; levels hold their corners, then the pins of the cell below them.
int corner(const MastShape& s, int k, int level) {
  const int faces = s.planar() ? 1 : s.sides;
  return level * (s.corners() + faces) - (level > 0 ? faces : 0) + k % s.corners();
}

void hold_base(Assembly& a, const MastShape& s) {
  if (s.planar()) {
    a.fix(corner(s, 0, 0));
    a.line(corner(s, 1, 0), Vec3::UnitX());
    return;
  }
  const int first = corner(s, 0, 0);
  for (int k = 0; k < s.sides; ++k) a.line(corner(s, k, 0), s.direction(k));
  for (int k = 1; k < s.sides; ++k)
    a.relation("equal radius of " + a.name(first + k) + " and " + a.name(first), {first + k, first},
               {s.direction(k), -s.direction(0)});
}

void add_scissor(Assembly& a, const MastShape& s, int k, int cell) {
  const int low = corner(s, k, cell), low_next = corner(s, k + 1, cell);
  const int high = corner(s, k, cell + 1), high_next = corner(s, k + 1, cell + 1);
  const std::string face = s.planar() ? "P" : s.letter(k) + s.letter((k + 1) % s.sides);
  const int pin = a.node(face + std::to_string(cell + 1), 0.5 * (a.position(low) + a.position(high_next)));
  const double mass = s.section.mass_per_length * s.l;
  a.rod(low, high_next, s.l, mass, "right arm", s.section.radius);
  a.rod(low_next, high, s.l, mass, "left arm", s.section.radius);
  a.pin_middles(pin, low, high_next, low_next, high);
}

void set_deployment(Structure& out, const MastShape& s, const ParamSet& p) {
  Deployment& d = out.deployment;
  const int base = corner(s, 0, 0), tip = corner(s, 0, s.cells);
  const Vec3 up = Vec3::UnitZ() / (s.cells * s.l);
  d.fold_cosine = {{base, tip}, {-up, up}, 0.0};
  if (s.planar())
    d.fold_sine = {{base, corner(s, 1, 0)}, {-Vec3::UnitX() / s.l, Vec3::UnitX() / s.l}, 0.0};
  else
    d.fold_sine = {{base}, {2.0 * std::sin(pi / s.sides) / s.l * s.direction(0)}, 0.0};
  d.initial_fold_angle = std::atan2(s.sine, s.cosine);
  d.deployed_fold_angle = p.real("deployed_angle") * radians_per_degree;
}

}  // namespace

const std::vector<ParamSpec>& scissor_mast_params() {
  static const std::vector<ParamSpec> params{
      integer_param("cells", 6, 1, 100000, "number of cells, the storeys of the mast"),
      integer_param("sides", 1, 1, 26, "1: planar; 3 and more: that many faces around the axis"),
      positive_param("rod_length", "m", 1.0, "length of a rod from end to end"),
      density_param(),
      section_area_param(4e-4),
      inside(real_param("fold_angle", "deg", 85.0, 0.0, 90.0, "angle of the rods with the axis at t = 0")),
      below_max(real_param("deployed_angle", "deg", 30.0, 0.0, 90.0,
                           "angle of the rods with the axis when deployed")),
      real_param("tip_force", "N", 20.0, -1e12, 1e12, "force along the axis, shared by the tip's corners"),
      real_param("tip_mass", "kg", 0.0, 0.0, 1e12, "payload, shared by the tip's corners"),
  };
  return params;
}

Structure build_scissor_mast(const ParamSet& params) {
  const MastShape s = mast_shape(params);
  Assembly a;
  const double share = 1.0 / s.corners();
  for (int level = 0; level <= s.cells; ++level) {
    const bool tip = level == s.cells;
    for (int k = 0; k < s.corners(); ++k) {
      const int node =
          a.node(s.letter(k) + std::to_string(level), s.at(k, level), tip ? share * s.tip_mass : 0.0);
      if (tip) a.load(node, share * s.tip_force * Vec3::UnitZ());
    }
    if (level == 0) {
      hold_base(a, s);
    } else {
      if (s.planar()) a.plane(corner(s, 0, level), Vec3::UnitY());
      for (int k = 0; k < (s.planar() ? 1 : s.sides); ++k) add_scissor(a, s, k, level - 1);
    }
  }
  set_deployment(a.structure, s, params);
  a.structure.kind = "scissor_mast";
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
