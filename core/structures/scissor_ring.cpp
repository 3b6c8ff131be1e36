// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/scissor_ring.hpp"

#include <cmath>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {

namespace {

struct RingShape {
  int n;
  double l, sine, cosine;  // rod length; of the fold angle
  RodSection section;

  double radius() const { return l * cosine / (2.0 * std::sin(pi / n)); }
  double corner_angle(int k) const { return 2.0 * pi * k / n; }
};

// Nodes of unit k are 3 k + these.
enum : int { bottom = 0, top = 1, crossing = 2 };

int node_of(const RingShape& s, int k, int role) {
  return 3 * (k % s.n) + role;
}

void add_unit(Assembly& a, const RingShape& s, int k) {
  const int low = node_of(s, k, bottom), low_next = node_of(s, k + 1, bottom);
  const int high = node_of(s, k, top), high_next = node_of(s, k + 1, top), middle = node_of(s, k, crossing);
  const double mass = s.section.mass_per_length * s.l;
  a.rod(low, high_next, s.l, mass, "right arm", s.section.radius);
  a.rod(low_next, high, s.l, mass, "left arm", s.section.radius);
  a.pin_middles(middle, low, high_next, low_next, high);
  a.plane(low, tangential(s.corner_angle(k)));
  if (k < 2) a.plane(high, tangential(s.corner_angle(k)));
  a.plane(middle, tangential(s.corner_angle(k) + pi / s.n));
}

void set_deployment(Structure& out, const RingShape& s, double deployed_degrees) {
  Deployment& d = out.deployment;
  d.fold_sine = {{bottom, top}, {-Vec3::UnitZ() / s.l, Vec3::UnitZ() / s.l}, 0.0};
  d.fold_cosine = {{bottom}, {2.0 * std::sin(pi / s.n) / s.l * Vec3::UnitX()}, 0.0};
  d.initial_fold_angle = std::atan2(s.sine, s.cosine);
  d.deployed_fold_angle = deployed_degrees * radians_per_degree;
}

}  // namespace

const std::vector<ParamSpec>& scissor_ring_params() {
  static const std::vector<ParamSpec> params{
      integer_param("units", 12, 3, 100000, "number of scissors around the ring"),
      positive_param("rod_length", "m", 1.0, "length of a rod from end to end"),
      density_param(),
      section_area_param(4e-4),
      inside(real_param("fold_angle", "deg", 85.0, 0.0, 90.0,
                        "angle of the rods with the ring's plane at t = 0")),
      below_max(real_param("deployed_angle", "deg", 20.0, 0.0, 90.0,
                           "angle of the rods with the ring's plane when deployed")),
      real_param("radial_force", "N", 10.0, -1e12, 1e12, "outward force on every corner node"),
  };
  return params;
}

Structure build_scissor_ring(const ParamSet& params) {
  RingShape s{};
  s.n = static_cast<int>(params.integer("units"));
  s.l = params.real("rod_length");
  const double fold = params.real("fold_angle"), deployed = params.real("deployed_angle");
  require_unfolding(fold, deployed);
  s.sine = std::sin(fold * radians_per_degree);
  s.cosine = std::sin((90.0 - fold) * radians_per_degree);  // keeps its digits near 90 degrees
  s.section = rod_section(params);
  Assembly a;
  for (int k = 0; k < s.n; ++k) {
    const Vec3 corner = s.radius() * radial(s.corner_angle(k)),
               half_height = 0.5 * s.l * s.sine * Vec3::UnitZ();
    const std::string i = std::to_string(k);
    a.node("B" + i, corner - half_height);
    a.node("T" + i, corner + half_height);
    a.node("P" + i, s.radius() * std::cos(pi / s.n) * radial(s.corner_angle(k) + pi / s.n));
    for (int role : {bottom, top})
      a.load(node_of(s, k, role), params.real("radial_force") * radial(s.corner_angle(k)));
  }
  for (int k = 0; k < s.n; ++k) add_unit(a, s, k);
  a.relation("mirror B0-T0", {bottom, top}, {Vec3::UnitZ(), Vec3::UnitZ()});
  set_deployment(a.structure, s, deployed);
  a.structure.kind = "scissor_ring";
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
