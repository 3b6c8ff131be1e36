// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/hoberman.hpp"

#include <cmath>
#include <cstdio>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {

namespace {

struct HobermanShape {
  int n;
  double p, gamma;  // bar length [m]; pi/2 - fold angle [rad]
  RodSection section;

  double pitch() const { return 2.0 * pi / n; }
  double scale() const { return p / std::sin(0.5 * pitch()); }
  Vec3 pin(int k) const { return scale() * std::sin(gamma) * radial(pitch() * k); }
  Vec3 inner(int k) const { return scale() * std::sin(gamma - 0.5 * pitch()) * radial(pitch() * (k + 0.5)); }
  Vec3 outer(int k) const { return scale() * std::sin(gamma + 0.5 * pitch()) * radial(pitch() * (k + 0.5)); }
};

HobermanShape hoberman_shape(const ParamSet& p) {
  HobermanShape s{};
  s.n = static_cast<int>(p.integer("units"));
  s.p = p.real("bar_length");
  const double fold = p.real("fold_angle"), closed = 90.0 - 180.0 / s.n;
  require_unfolding(fold, p.real("deployed_angle"));
  if (!(fold < closed)) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "with %d units the inner nodes meet at the centre at a fold angle of %.12g degrees: "
                  "fold_angle must be "
                  "smaller",
                  s.n, closed);
    throw StructureError("fold_angle", text);
  }
  s.gamma = (90.0 - fold) * radians_per_degree;
  s.section = rod_section(p);
  return s;
}

// Nodes of unit k are 3 k + these.
enum : int { pin = 0, inner = 1, outer = 2 };

int node_of(const HobermanShape& s, int k, int role) {
  return 3 * ((k + s.n) % s.n) + role;
}

void add_element(Assembly& a, const HobermanShape& s, int from, int kink, int to, const char* group) {
  const double mass = s.section.mass_per_length * s.p;
  a.rod(from, kink, s.p, mass, group, s.section.radius);
  a.rod(kink, to, s.p, mass, group, s.section.radius);
}

void set_deployment(Structure& out, const HobermanShape& s, double deployed_degrees) {
  Deployment& d = out.deployment;
  const Vec3 e = radial(0.5 * s.pitch()) / (2.0 * s.p);
  d.fold_sine = {{outer, inner}, {e, -e}, 0.0};
  d.fold_cosine = {{pin}, {Vec3::UnitX() / s.scale()}, 0.0};
  d.initial_fold_angle = 0.5 * pi - s.gamma;
  d.deployed_fold_angle = deployed_degrees * radians_per_degree;
}

}  // namespace

const std::vector<ParamSpec>& hoberman_params() {
  static const std::vector<ParamSpec> params{
      integer_param("units", 12, 3, 100000, "pairs of angulated elements around the ring"),
      positive_param("bar_length", "m", 0.5, "length of one of the two bars of an element"),
      density_param(),
      section_area_param(2e-4),
      inside(real_param("fold_angle", "deg", 70.0, 0.0, 90.0,
                        "fold angle at t = 0: 0 is the largest ring, 90 - 180/units the closed one")),
      below_max(real_param("deployed_angle", "deg", 10.0, 0.0, 90.0, "fold angle when deployed")),
      real_param("radial_force", "N", 10.0, -1e12, 1e12, "outward force on every pin"),
  };
  return params;
}

Structure build_hoberman(const ParamSet& params) {
  const HobermanShape s = hoberman_shape(params);
  Assembly a;
  for (int k = 0; k < s.n; ++k) {
    const std::string i = std::to_string(k);
    const int first = a.node("P" + i, s.pin(k));
    a.node("I" + i, s.inner(k));
    a.node("O" + i, s.outer(k));
    a.line(first + pin, radial(s.pitch() * k));
    a.plane(first + inner, Vec3::UnitZ());
    a.plane(first + outer, Vec3::UnitZ());
    a.load(first + pin, params.real("radial_force") * radial(s.pitch() * k));
  }
  for (int k = 0; k < s.n; ++k) {
    add_element(a, s, node_of(s, k - 1, inner), node_of(s, k, pin), node_of(s, k, outer), "left element");
    add_element(a, s, node_of(s, k, inner), node_of(s, k, pin), node_of(s, k - 1, outer), "right element");
  }
  const double chord = 2.0 * s.p * std::cos(0.5 * s.pitch());  // of an element's ends
  for (int k = 0; k < s.n; ++k) {
    a.brace(node_of(s, k - 1, inner), node_of(s, k, outer), chord);
    a.brace(node_of(s, k, inner), node_of(s, k - 1, outer), chord);
  }
  set_deployment(a.structure, s, params.real("deployed_angle"));
  a.structure.kind = "hoberman";
  show_as_solved(a.structure);
  hide_braces(a.structure);
  return a.structure;
}

}  // namespace unfurl
