// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/rod_material.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "core/structure/structure_error.hpp"
#include "core/structures/segments.hpp"

namespace unfurl {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

std::string metres_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g m", x);
  return text;
}

}  // namespace

bool RodMaterial::elastic() const {
  return std::isfinite(youngs_modulus);
}

const std::vector<ParamSpec>& rod_material_params() {
  static const std::vector<ParamSpec> params{
      positive_param("youngs_modulus", "Pa", unbounded,
                     "of the rods: how they share forces that rigid ones leave open, stress, buckling, "
                     "frequencies; inf: rigid"),
      positive_param("strength", "Pa", unbounded, "axial stress that the rods may bear"),
      choice_param("section", "round", {"round", "tube", "square"},
                   "shape of the cross section, for buckling"),
      only_with(
          "section", {"tube"},
          positive_param("wall_thickness", "m", unbounded, "of a tube; its diameter follows from the area")),
      choice_param(
          "rod_model", "rigid", {"rigid", "quasi-static", "elastic"},
          "elastic: rods with a youngs_modulus give, with waves; quasi-static: the rigid motion, what "
          "its forces stretch added to what is shown"),
      only_with("rod_model", {"elastic"},
                real_param("damping_ratio", "", 0.0, 0.0, unbounded,
                           "of elastic rods, of critical damping where a rod is free and alone")),
      only_with("rod_model", {"elastic"},
                real_param("damping_time", "s", 0.0, 0.0, unbounded,
                           "of elastic rods, in place of damping_ratio: stress = E (strain + damping_time * "
                           "its rate)")),
      integer_param("segments", 1, 1, 1000,
                    "that rods with a youngs_modulus are cut into, to bend between their ends"),
      real_param("length_error", "m", 0.0, 0.0, unbounded,
                 "of the rods as they are made, standard deviation; elastic rods are joined all the same"),
      only_given("length_error", integer_param("error_seed", 1, 0, 1000000000,
                                               "of the errors: another number, other errors")),
  };
  return params;
}

RodMaterial rod_material(const ParamSet& values) {
  return {values.real("youngs_modulus"), values.real("strength"),    values.text("section"),
          values.real("wall_thickness"), values.text("rod_model"),   values.real("damping_ratio"),
          values.real("damping_time"),   values.integer("segments"), values.real("length_error"),
          values.integer("error_seed")};
}

ParamSet rod_material_values(const RodMaterial& material) {
  ParamSet values(rod_material_params());
  values.set("youngs_modulus", material.youngs_modulus);
  values.set("strength", material.strength);
  values.set("section", material.section);
  values.set("wall_thickness", material.wall_thickness);
  values.set("rod_model", material.rod_model);
  values.set("damping_ratio", material.damping_ratio);
  values.set("damping_time", material.damping_time);
  values.set("segments", material.segments);
  values.set("length_error", material.length_error);
  values.set("error_seed", material.error_seed);
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
        "a tube needs the thickness of its wall, at most sqrt(area / pi) = " + metres_text(r));
  const double outer = area / (pi * t) + t, inner = outer - 2 * t;
  return {pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4)), outer / 2};
}

double damping_time_of(const RodMaterial& material, const Rod& rod, bool lumped, long segments) {
  if (material.damping_ratio == 0 || !(rod.mass > 0)) return material.damping_time;
  const double k = rod.youngs_modulus * rod.area / rod.natural_length();
  const auto n = static_cast<double>(std::max(segments, 1L));
  const double c = std::cos(pi / n),
               w = n * std::sqrt(2 * (1 - c) * (lumped ? 1 : 3 / (2 + c)) * k / rod.mass);
  return 2 * material.damping_ratio / w;
}

void check_rod_model(const RodMaterial& material) {
  if (material.damping_ratio > 0 && material.damping_time > 0)
    throw StructureError("damping_time", "give damping_ratio or damping_time, not both");
  if (material.rod_model != "rigid" && !material.elastic())
    throw StructureError("youngs_modulus",
                         "rod_model = \"" + material.rod_model + "\" needs the youngs_modulus of the rods");
}

// Uniform in (0, 1] from counters (splitmix64), normal by Box and Muller.
namespace {

double uniform(std::uint64_t counter) {
  std::uint64_t x = counter * 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>(((x ^ (x >> 31)) >> 11) + 1) / 9007199254740992.0;
}

double normal(std::uint64_t seed, std::uint64_t index) {
  const std::uint64_t at = (seed << 32) + 2 * index + 1;
  return std::sqrt(-2 * std::log(uniform(at))) * std::cos(2 * pi * uniform(at + 1));
}

}  // namespace

void add_length_errors(Structure& structure, const RodMaterial& material) {
  if (material.length_error == 0) return;
  if (structure.sectors > 1 || structure.node_copies.size() != structure.nodes.size())
    throw StructureError("length_error",
                         "errors of length break the symmetry of a sector model; set structure.model to "
                         "\"full\"");
  // Of a truss with its mass in its nodes, too; not of what only holds a shape.
  const std::vector<char> shown = shown_rods(structure);
  std::vector<std::string> exact;
  for (std::size_t r = 0; r < structure.rods.size(); ++r) {
    Rod& rod = structure.rods[r];
    if (!(rod.mass > 0 || rod.area > 0)) {
      if (shown[r]) exact.push_back(rod.name);
      continue;
    }
    double& made = rod.free_length > 0 ? rod.free_length : rod.length;
    made += material.length_error * normal(static_cast<std::uint64_t>(material.error_seed), r);
    if (!(made > 0))
      throw StructureError("length_error", "rod " + rod.name + " would be made " + metres_text(made) +
                                               " long; take a smaller length_error");
  }
  if (!exact.empty())
    structure.notes.push_back("length_error leaves out rods with neither mass nor area: " + exact.front() +
                              (exact.size() > 1 ? " and " + std::to_string(exact.size() - 1) + " more" : ""));
}

void note_idle_material(Structure& structure, const RodMaterial& material) {
  if (std::ranges::any_of(structure.rods, &Rod::elastic)) return;
  const auto idle = [&](const char* key, bool given) {
    if (given)
      structure.notes.push_back(std::string(key) + " does nothing: no rod has a youngs_modulus and an area");
  };
  idle("strength", std::isfinite(material.strength));
  idle("section", material.section == "square");
  idle("segments", material.segments > 1);
}

namespace {

// Told the ends of what a constraint holds a node between, and that node: the middle of two nodes, or a point
// on the line through them, however it is written. It stands there, as places are rounded: one of a single
// coordinate may tie what is far.
template <class Visit>
void for_each_pin_between(const Structure& structure, const Visit& visit) {
  const auto at = [&](int node) -> const Vec3& {
    return structure.nodes[static_cast<std::size_t>(node)].position;
  };
  for (const Constraint& c : structure.constraints) {
    const auto& n = c.nodes;
    const auto alike = [&](std::size_t a, std::size_t b) { return c.vectors[a].dot(c.vectors[b]) > 0; };
    // Nodes of a sector stand for others.
    const auto on = [&](std::size_t a, std::size_t b, const Vec3& there) {
      const Vec3 along = at(n[b]) - at(n[a]), from = there - at(n[a]);
      const double u = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
      return structure.sectors > 1 || (from - u * along).norm() <= 1e-3 * along.norm();
    };
    const auto crossing = [&](std::size_t a, std::size_t b) {
      const double of_a = c.vectors[a].norm(), of_b = c.vectors[b].norm();
      return Vec3((of_a * at(n[a]) + of_b * at(n[b])) / (of_a + of_b));
    };
    if (c.kind == "relation" && n.size() == 4)  // where two cross
      for (std::size_t other = 1; other < 4; ++other) {
        const std::size_t third = other == 1 ? 2 : 1, fourth = 6 - other - third;
        if (!alike(0, other) || !alike(third, fourth) || alike(0, third)) continue;
        if (!on(0, other, crossing(third, fourth))) continue;
        visit(n[0], n[other], n[third]), visit(n[third], n[fourth], n[0]);
      }
    if (n.size() != 3 || (c.kind != "relation" && c.kind != "collinear")) continue;
    for (std::size_t pin = 0; pin < 3; ++pin) {
      const std::size_t a = (pin + 1) % 3, b = (pin + 2) % 3;
      const bool lies = c.kind == "relation" ? alike(a, b) && !alike(a, pin) && on(a, b, at(n[pin]))
                                             : (at(n[a]) - at(n[pin])).dot(at(n[b]) - at(n[pin])) < 0;
      if (lies) visit(n[a], n[b], n[pin]);
    }
  }
}

// The ends of rods that are cut.
std::set<std::pair<int, int>> ends_of_cut_rods(const Structure& structure) {
  std::map<std::string, std::pair<int, int>> ends;
  for (const Rod& part : structure.rods) {
    if (part.whole.empty()) continue;
    const auto [whole, first] = ends.try_emplace(part.whole, part.a, part.b);
    if (!first) whole->second.second = part.b;
  }
  std::set<std::pair<int, int>> out;
  for (const auto& [name, pair] : ends) out.insert(std::minmax(pair.first, pair.second));
  return out;
}

}  // namespace

void note_pins_between(Structure& structure) {
  std::map<std::pair<int, int>, const Rod*> elastic;
  for (const Rod& rod : structure.rods)
    if (rod.elastic()) elastic[std::minmax(rod.a, rod.b)] = &rod;
  if (elastic.empty()) return;
  const std::set<std::pair<int, int>> cut = ends_of_cut_rods(structure);
  std::set<const Rod*> pinned;
  for_each_pin_between(structure, [&](int a, int b, int pin) {
    if (cut.count(std::minmax(a, b)) > 0)
      throw StructureError("segments", "rods that carry a pin between their ends (" +
                                           structure.nodes[static_cast<std::size_t>(pin)].name +
                                           ") cannot be cut");
    if (const auto it = elastic.find(std::minmax(a, b)); it != elastic.end()) pinned.insert(it->second);
  });
  if (pinned.empty()) return;
  structure.notes.push_back(
      "stress, buckling and strength of " + std::to_string(pinned.size()) +
      (pinned.size() == 1 ? " rod" : " rods") +
      " with pins between the ends are those of the mean force along it: beside a pin it may be "
      "twice as large (scissors); model such a rod as two in line to see it");
}

void give_material(Structure& structure, double area, const RodMaterial& material) {
  check_rod_model(material);
  structure.quasi_static = material.rod_model == "quasi-static";
  const SectionShape shape = section_shape(material, area);
  std::vector<long> segments(structure.rods.size(), 1);
  for (std::size_t r = 0; r < structure.rods.size(); ++r) {
    Rod& rod = structure.rods[r];
    if (!(rod.mass > 0)) continue;
    rod.area = area;
    rod.youngs_modulus = material.youngs_modulus;
    rod.strength = material.strength;
    rod.second_moment = shape.second_moment;
    if (material.section == "tube") rod.radius = shape.radius;
    rod.gives = material.rod_model == "elastic";
    rod.damping_time = damping_time_of(material, rod, structure.lumped_mass, material.segments);
    segments[r] = material.segments;
  }
  note_idle_material(structure, material);
  add_length_errors(structure, material);
  cut_rods(structure, segments);
}

}  // namespace unfurl
