// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/reentrant_sheet.hpp"

#include <cmath>
#include <cstdio>

#include "core/structure/structure_error.hpp"
#include "core/structures/assembly.hpp"

namespace unfurl {

namespace {

struct SheetShape {
  int rows, columns;
  double l, h, sine, cosine;  // chord rod, post; of the fold angle
  RodSection section;

  int width() const { return 2 * columns + 1; }  // nodes of a zigzag
  int node(int j, int i) const { return j * width() + i; }
  bool high(int j, int i) const { return (i - j) % 2 != 0; }
  Vec3 at(int j, int i) const {
    const double total = rows * (h - l * sine) + l * sine;
    return {(i - columns) * l * cosine, 0.0,
            j * (h - l * sine) + (high(j, i) ? l * sine : 0.0) - 0.5 * total};
  }
};

SheetShape sheet_shape(const ParamSet& p) {
  SheetShape s{};
  s.rows = static_cast<int>(p.integer("rows"));
  s.columns = static_cast<int>(p.integer("columns"));
  s.l = p.real("chord_rod_length");
  s.h = p.real("post_length");
  const double fold = p.real("fold_angle");
  require_unfolding(fold, p.real("deployed_angle"));
  s.sine = std::sin(fold * radians_per_degree);
  s.cosine = std::sin((90.0 - fold) * radians_per_degree);  // keeps its digits near 90 degrees
  s.section = rod_section(p);
  if (!(s.h > 2.0 * s.l * s.sine)) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "chords would cross inside the units: post_length must be more than 2 chord_rod_length "
                  "sin(fold_angle) = %.12g m",
                  2.0 * s.l * s.sine);
    throw StructureError("post_length", text);
  }
  return s;
}

void add_zigzag(Assembly& a, const SheetShape& s, int j) {
  const double mass = s.section.mass_per_length * s.l;
  for (int i = 0; i + 1 < s.width(); ++i)
    a.rod(s.node(j, i), s.node(j, i + 1), s.l, mass, "chord", s.section.radius);
  for (int i = 2; i < s.width(); ++i)
    a.relation("level of " + a.name(s.node(j, i)), {s.node(j, i), s.node(j, i - 2)},
               {Vec3::UnitZ(), -Vec3::UnitZ()});
}

void add_posts(Assembly& a, const SheetShape& s, int j) {
  for (int i = 0; i < s.width(); ++i) {
    if (s.high(j, i)) continue;
    const int low = s.node(j, i), top = s.node(j + 1, i);
    a.rod(low, top, s.h, s.section.mass_per_length * s.h, "post", s.section.radius);
    a.relation("vertical post " + a.name(low) + "-" + a.name(top), {low, top},
               {Vec3::UnitX(), -Vec3::UnitX()});
  }
}

// A single column leaves rows that join by one post, which would let zigzags be of different widths: their
// ends stand in line then.
void align_ends(Assembly& a, const SheetShape& s) {
  if (s.columns > 1) return;
  for (int j = 1; j < s.rows; j += 2) {
    const int low = s.node(j, 0), top = s.node(j + 1, 0);
    a.relation("ends " + a.name(low) + " and " + a.name(top) + " in line", {low, top},
               {Vec3::UnitX(), -Vec3::UnitX()});
  }
}

// In the plane y = 0, and centred on the origin.
void hold(Assembly& a, const SheetShape& s) {
  for (int k = 0; k < static_cast<int>(a.structure.nodes.size()); ++k) a.plane(k, Vec3::UnitY());
  a.plane(s.node(0, s.columns), Vec3::UnitX());
  const int low = s.node(0, 0), high = s.node(s.rows, (s.rows + 1) % 2);
  a.relation("centre between " + a.name(low) + " and " + a.name(high), {low, high},
             {Vec3::UnitZ(), Vec3::UnitZ()});
}

void set_measures(Structure& out, const SheetShape& s, double deployed_degrees) {
  const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  const int first = s.node(0, 0), last = s.node(0, s.width() - 1);
  Deployment& d = out.deployment;
  d.fold_sine = {{first, s.node(0, 1)}, {-z / s.l, z / s.l}, 0.0};
  d.fold_cosine = {{first, last}, {-x / (2.0 * s.columns * s.l), x / (2.0 * s.columns * s.l)}, 0.0};
  d.initial_fold_angle = std::atan2(s.sine, s.cosine);
  d.deployed_fold_angle = deployed_degrees * radians_per_degree;
  out.lengths = {
      {"column_pitch_m", "column pitch", {{first, last}, {-x / s.columns, x / s.columns}, 0.0}},
      {"row_pitch_m", "row pitch", {{first, s.node(s.rows, s.rows % 2)}, {-z / s.rows, z / s.rows}, 0.0}}};
  out.strain_along = 0;
  out.strain_across = 1;
}

}  // namespace

const std::vector<ParamSpec>& reentrant_sheet_params() {
  static const std::vector<ParamSpec> params{
      integer_param("rows", 4, 1, 10000, "rows of units, along z"),
      integer_param("columns", 5, 1, 10000, "units of a row, along x"),
      positive_param("chord_rod_length", "m", 0.5, "length of a chord rod, half a chord"),
      positive_param("post_length", "m", 1.0, "length of a post"),
      density_param(),
      section_area_param(1e-4),
      inside(real_param("fold_angle", "deg", 60.0, 0.0, 90.0,
                        "angle of the chord rods with the x axis at t = 0")),
      below_max(real_param("deployed_angle", "deg", 10.0, 0.0, 90.0,
                           "angle of the chord rods when deployed; 0 is flat")),
      real_param("stretch_force", "N", 20.0, -1e12, 1e12, "pull along x on either side, shared by its nodes"),
  };
  return params;
}

Structure build_reentrant_sheet(const ParamSet& params) {
  const SheetShape s = sheet_shape(params);
  Assembly a;
  const Vec3 pull = params.real("stretch_force") / (s.rows + 1) * Vec3::UnitX();
  for (int j = 0; j <= s.rows; ++j)
    for (int i = 0; i < s.width(); ++i) a.node("R" + std::to_string(j) + "C" + std::to_string(i), s.at(j, i));
  for (int j = 0; j <= s.rows; ++j) {
    add_zigzag(a, s, j);
    if (j < s.rows) add_posts(a, s, j);
    a.load(s.node(j, 0), -pull);
    a.load(s.node(j, s.width() - 1), pull);
  }
  align_ends(a, s);
  hold(a, s);
  set_measures(a.structure, s, params.real("deployed_angle"));
  a.structure.kind = "reentrant_sheet";
  show_as_solved(a.structure);
  return a.structure;
}

}  // namespace unfurl
