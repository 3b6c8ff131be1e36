// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/bricard.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"
#include "core/structures/ring.hpp"

namespace unfurl {

namespace {

struct BricardShape {
  double L, pin;          // [m]
  double S1, C1, S2, C2;  // of half the angles at the odd and the even hinges

  bool odd(int i) const { return i % 2 == 0; }  // hinge i + 1
  Vec3 outward(int i) const { return radial(pi / 3.0 * i); }
  double height() const { return L * std::sqrt(1.0 - 4.0 / 3.0 * (S1 * S1 - S1 * S2 + S2 * S2)); }
  Vec3 hinge(int i) const {
    const double r = 2.0 / std::sqrt(3.0) * L * (odd(i) ? S2 : S1);
    return r * outward(i) + (odd(i) ? -0.5 : 0.5) * height() * Vec3::UnitZ();
  }
  // Across both bars that meet at the hinge; points away from the z axis.
  Vec3 axis(int i) const {
    const double p = 2.0 / std::sqrt(3.0) * L * (odd(i) ? 0.5 * S1 - S2 : 0.5 * S2 - S1);
    return (height() * outward(i) + (odd(i) ? -p : p) * Vec3::UnitZ()).normalized();
  }
};

[[noreturn]] void refuse(const char* key, const char* format, double a, double b) {
  char text[240];
  std::snprintf(text, sizeof text, format, a, b);
  throw StructureError(key, text);
}

// The opening angle [deg] from which the loop can be closed: where theta_2 is double or the bars at the even
// hinges coincide (theta_2 = 0).
double least_opening(double twist) {
  const double c = std::cos(twist * radians_per_degree);
  const double half =
      c * c < 0.25 ? std::asin(std::sqrt((0.25 - c * c) / (1.0 - c * c))) : std::acos(-0.5 / c);
  return 2.0 * half / radians_per_degree;
}

// theta_2 from the closure: with R sin(delta) = cos(alpha) C_1, R cos(delta) = S_1 it reads R sin(theta_2/2 -
// delta) = 1/2.
BricardShape bricard_shape(const ParamSet& p) {
  BricardShape s{};
  s.L = p.real("bar_length");
  s.pin = p.real("pin_length");
  const double twist = p.real("twist_angle"), opening = p.real("opening_angle");
  if (!(opening > least_opening(twist)))
    refuse("opening_angle",
           "with twist_angle = %.12g degrees the loop closes for an opening_angle above %.12g degrees", twist,
           least_opening(twist));
  s.S1 = std::sin(0.5 * opening * radians_per_degree);
  s.C1 = std::cos(0.5 * opening * radians_per_degree);
  const double across = std::cos(twist * radians_per_degree) * s.C1, R = std::hypot(s.S1, across);
  const double half = std::atan2(across, s.S1) + std::asin(0.5 / R);
  s.S2 = std::sin(half);
  s.C2 = std::cos(half);
  return s;
}

void add_link(Assembly& a, const BricardShape& s, const RodSection& section, int i) {
  const int x = 2 * i, y = x + 1, x_next = (x + 2) % 12, y_next = x_next + 1;
  a.rod(x, x_next, s.L, section.mass_per_length * s.L, "bar", section.radius);
  a.rod(x, y, s.pin, section.mass_per_length * s.pin, "hinge pin", section.radius);
  const auto distance = [&](int from, int to) { return (a.position(to) - a.position(from)).norm(); };
  for (const auto& [from, to] : {std::array{x, y_next}, {y, x_next}, {y, y_next}})
    a.brace(from, to, distance(from, to));
}

// Linear in the positions: the tangent is height / L over S_1, and L S_1 half the side of the triangle of the
// even hinges. The bars' own slope, of the sine height / L, is not; both are zero in the flat pose and 90
// degrees in the bundle.
void set_deployment(Structure& out, const BricardShape& s, double deployed_degrees) {
  Deployment& d = out.deployment;
  for (int i = 0; i < 6; ++i) {
    d.fold_sine.nodes.push_back(2 * i);
    d.fold_sine.coefficients.push_back((s.odd(i) ? -1.0 : 1.0) / (3.0 * s.L) * Vec3::UnitZ());
    if (s.odd(i)) continue;
    d.fold_cosine.nodes.push_back(2 * i);
    d.fold_cosine.coefficients.push_back(0.5 * std::sqrt(3.0) / (3.0 * s.L) * s.outward(i));
  }
  d.initial_fold_angle = std::atan2(s.height() / s.L, s.S1);
  d.deployed_fold_angle = deployed_degrees * radians_per_degree;
  const double start = d.initial_fold_angle / radians_per_degree;
  if (!unfolds(start, deployed_degrees))
    refuse("deployed_angle",
           "deployed_angle = %.12g degrees must be smaller than the fold angle at the start, %.12g degrees",
           deployed_degrees, start);
}

}  // namespace

const std::vector<ParamSpec>& bricard_params() {
  static const std::vector<ParamSpec> params{
      positive_param("bar_length", "m", 1.0, "length of a bar"),
      positive_param("pin_length", "m", 0.15, "length of a hinge's pin"),
      density_param(),
      section_area_param(2e-4),
      real_param("twist_angle", "deg", 120.0, 90.0, 150.0,
                 "angle between the hinge axes of a bar; at 120 the loop folds to a bundle"),
      inside(real_param("opening_angle", "deg", 30.0, 0.0, 180.0,
                        "angle between the bars at hinges 1, 3, 5 at t = 0")),
      below_max(real_param(
          "deployed_angle", "deg", 3.0, 0.0, 90.0,
          "fold angle when deployed; its tangent is the height of hinges 2, 4, 6 above the others over "
          "half the side of their triangle; 0 is flat")),
      real_param("radial_force", "N", 5.0, -1e12, 1e12, "outward force on each of the hinges 2, 4, 6"),
  };
  return params;
}

Structure build_bricard(const ParamSet& params) {
  const BricardShape s = bricard_shape(params);
  const RodSection section = rod_section(params);
  Assembly a;
  for (int i = 0; i < 6; ++i) {
    const std::string number = std::to_string(i + 1);
    const int x = a.node("X" + number, s.hinge(i));
    a.node("Y" + number, s.hinge(i) + s.pin * s.axis(i));
    if (!s.odd(i)) a.load(x, params.real("radial_force") * s.outward(i));
  }
  for (int i = 0; i < 6; ++i) add_link(a, s, section, i);
  set_deployment(a.structure, s, params.real("deployed_angle"));
  a.structure.kind = "bricard";
  show_as_solved(a.structure);
  hide_braces(a.structure);
  return a.structure;
}

}  // namespace unfurl
