// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/rod_material.hpp"

#include <cmath>
#include <cstdio>

#include "core/structure/structure_error.hpp"

namespace unfurl {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

std::string thickness_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", x);
  return text;
}

}  // namespace

bool RodMaterial::elastic() const {
  return std::isfinite(youngs_modulus);
}

const std::vector<ParamSpec>& rod_material_params() {
  static const std::vector<ParamSpec> params{
      positive_param("youngs_modulus", "Pa", endless,
                     "of the rods: how they share forces that rigid ones leave open, stress, buckling, "
                     "frequencies; inf: rigid"),
      positive_param("strength", "Pa", endless, "axial stress that the rods may bear"),
      choice_param("section", "round", {"round", "tube", "square"},
                   "shape of the cross section, for buckling"),
      only_with(
          "section", {"tube"},
          positive_param("wall_thickness", "m", endless, "of a tube; its diameter follows from the area")),
  };
  return params;
}

RodMaterial rod_material(const ParamSet& values) {
  return {values.real("youngs_modulus"), values.real("strength"), values.text("section"),
          values.real("wall_thickness")};
}

ParamSet rod_material_values(const RodMaterial& material) {
  ParamSet values(rod_material_params());
  values.set("youngs_modulus", material.youngs_modulus);
  values.set("strength", material.strength);
  values.set("section", material.section);
  values.set("wall_thickness", material.wall_thickness);
  return values;
}

SectionShape section_shape(const RodMaterial& material, double area) {
  const double r = std::sqrt(area / pi);
  if (material.section == "round") return {area * area / (4 * pi), r};
  if (material.section == "square") return {area * area / 12, r};
  const double t = material.wall_thickness;
  if (!(t <= r))
    throw StructureError(
        "wall_thickness",
        "a tube needs the thickness of its wall, at most sqrt(area / pi) = " + thickness_text(r));
  const double outer = area / (pi * t) + t, inner = outer - 2 * t;
  return {pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4)), outer / 2};
}

void give_material(Structure& structure, double area, const RodMaterial& material) {
  const SectionShape shape = section_shape(material, area);
  for (Rod& rod : structure.rods) {
    if (!(rod.mass > 0)) continue;
    rod.area = area;
    rod.youngs_modulus = material.youngs_modulus;
    rod.strength = material.strength;
    rod.second_moment = shape.second_moment;
    if (material.section == "tube") rod.radius = shape.radius;
  }
}

}  // namespace unfurl
