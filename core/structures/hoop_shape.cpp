// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/hoop_shape.hpp"

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"

namespace unfurl {

namespace {

void check(const ParamSet& p) {
  const bool joints = p.text("model") == "joints";
  if (!p.boolean("closed") && !joints)
    throw StructureError("closed",
                         "an open arc has no planes of symmetry: closed = false needs model = \"joints\"");
  const long unit = p.integer("perturbed_unit");
  if (unit >= 0 && !joints)
    throw StructureError("perturbed_unit",
                         "planes of symmetry keep all units alike: perturbed_unit needs model = \"joints\"");
  if (unit >= p.integer("units"))
    throw StructureError("perturbed_unit", "perturbed_unit = " + std::to_string(unit) + " is none of the " +
                                               std::to_string(p.integer("units")) +
                                               " units, which count from 0");
}

}  // namespace

HoopShape hoop_shape(const ParamSet& p) {
  check(p);
  HoopShape s;
  s.n = static_cast<int>(p.integer("units"));
  if (!p.boolean("closed")) s.arc = p.real("arc_angle") * radians_per_degree;
  s.l1 = p.real("chord_rod_length");
  s.l2 = p.real("post_length");
  const double degrees = p.real("fold_angle");
  require_unfolding(degrees, 0.0);
  s.sine = std::sin(degrees * radians_per_degree);
  s.cosine = std::sin((90.0 - degrees) * radians_per_degree);  // keeps its digits near 90 degrees
  const double per_length = p.real("density") * p.real("section_area");
  s.chord_mass = per_length * s.l1;
  s.post_mass = per_length * s.l2;
  s.radius = std::sqrt(p.real("section_area") / pi);
  s.hinge_force = p.real("hinge_force");
  s.perturbed_unit = static_cast<int>(p.integer("perturbed_unit"));
  s.perturbed_force = p.real("perturbed_force");
  return s;
}

}  // namespace unfurl
