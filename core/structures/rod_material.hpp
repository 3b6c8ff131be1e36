// SPDX-License-Identifier: BSD-3-Clause
// What rods are made of and the shape of their cross section.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/structure/structure.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

struct RodMaterial {
  double youngs_modulus = std::numeric_limits<double>::infinity();  // infinite: rigid [Pa]
  double strength = std::numeric_limits<double>::infinity();        // axial stress that it may bear [Pa]
  std::string section = "round";                                    // round | tube | square
  double wall_thickness = std::numeric_limits<double>::infinity();  // of a tube [m]
  std::string rod_model = "rigid";                                  // rigid | quasi-static | elastic
  double damping_ratio = 0.0;                                       // of a rod that gives, free and alone
  double damping_time = 0.0;  // its stress is E (strain + damping_time * rate of strain) [s]
  long segments = 1;          // that a rod with a modulus is cut into, to bend
  double length_error = 0.0;  // standard deviation of the lengths as made [m]
  long error_seed = 1;

  bool elastic() const;
};

// Keys of every structure whose rods have an area.
const std::vector<ParamSpec>& rod_material_params();
RodMaterial rod_material(const ParamSet& values);           // values: of these and other keys
ParamSet rod_material_values(const RodMaterial& material);  // and back

// Of a cross section of area A [m^2]:
//     round   A = pi r^2, I = A^2 / (4 pi)
//     square  A = a^2,    I = A^2 / 12
//     tube    A = pi t (D - t), I = pi/64 (D^4 - (D - 2 t)^4), which needs t <= sqrt(A / pi)
struct SectionShape {
  double second_moment = 0.0;  // [m^4]
  double radius = 0.0;         // as drawn: of the round rod of the same area, or of the tube outside [m]
};
// Throws StructureError with "wall_thickness" where there is no such tube.
SectionShape section_shape(const RodMaterial& material, double area);

// The damping time of a rod that gives [s]: the ratio is that of how the rod, free and alone, stretches and
// shrinks, T = 2 ratio / w. Of mass m, stiffness k = E A / l and n segments, with c = cos(pi / n), its
// slowest such motion as it is solved has
//
//     w^2 = 6 n^2 (1 - c) / (2 + c) k / m,   12 k / m of one element,
//     w^2 = 2 n^2 (1 - c) k / m,              4 k / m,  where its mass is lumped at the nodes.
double damping_time_of(const RodMaterial& material, const Rod& rod, bool lumped, long segments);

// Throws StructureError where the model of the rods and what is known of them do not fit.
void check_rod_model(const RodMaterial& material);

// What rods get wrong when they are made: lengths off by normally distributed errors, the same for the same
// seed on every machine. An error is that of a whole rod, before it is cut into segments. Throws
// StructureError in a sector model, whose symmetry they break.
void add_length_errors(Structure& structure, const RodMaterial& material);

// Notes what of the material does nothing because no rod is elastic.
void note_idle_material(Structure& structure, const RodMaterial& material);

// Notes that stress and margins of elastic rods with pins between their ends are those of their mean force.
void note_pins_between(Structure& structure);

// Gives every rod that has a mass this area [m^2] and material; cuts them into segments.
void give_material(Structure& structure, double area, const RodMaterial& material);

}  // namespace unfurl
