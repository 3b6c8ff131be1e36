// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/custom.hpp"

#include <algorithm>
#include <cmath>

#include "core/structure/structure_error.hpp"
#include "core/structures/segments.hpp"
#include "core/text/name_index.hpp"

namespace unfurl {

namespace {

double rod_mass(const CustomRod& rod, double length) {
  return rod.mass.value_or(rod.density * rod.area * length);
}

long segments_of(const RodMaterial& all, const CustomRod& entry, const Rod& rod) {
  return entry.segments > 0 ? entry.segments : rod.elastic() ? all.segments : 1;
}

// Of a rod with an area: what it says itself, else what the list says of all rods.
void give_section(const CustomSpec& spec, const CustomRod& entry, Rod& rod) {
  const RodMaterial& all = spec.material;
  const SectionShape shape = section_shape(all, entry.area);
  const auto own = [](double x, double of_all) { return std::isnan(x) ? of_all : x; };
  rod.area = entry.area;
  rod.radius = shape.radius;
  rod.youngs_modulus = own(entry.youngs_modulus, all.youngs_modulus);
  rod.strength = own(entry.strength, all.strength);
  rod.second_moment = entry.second_moment > 0.0 ? entry.second_moment : shape.second_moment;
  rod.gives = rod.elastic() && gives_in_motion(all, entry);
  if (!rod.gives) return;
  rod.free_length = entry.free_length;
  rod.damping_time = damping_time_of(all, rod, spec.lumped_mass, segments_of(all, entry, rod));
}

void add_nodes(const CustomSpec& spec, Structure& structure) {
  for (const auto& entry : spec.nodes) {
    const int index = static_cast<int>(structure.nodes.size());
    structure.nodes.push_back({entry.name, entry.position, entry.velocity, entry.mass});
    if (entry.fixed)
      structure.constraints.push_back({"fixed", "fixed of " + entry.name, {index}, {}, 0.0, {}, {}});
  }
}

// What rods say themselves of a section that no modulus asks for.
void note_idle_sections(const CustomSpec& spec, Structure& structure) {
  const auto note = [&](const char* key, const auto& given) {
    std::size_t first = 0, count = 0;
    for (std::size_t r = 0; r < spec.rods.size(); ++r)
      if (given(spec.rods[r]) && !structure.rods[r].elastic() && count++ == 0) first = r;
    if (count == 0) return;
    const std::string others = count == 1 ? "" : " and of " + std::to_string(count - 1) + " more";
    structure.notes.push_back(std::string(key) + " of rod " + structure.rods[first].name + others +
                              " does nothing without a youngs_modulus and an area");
  };
  note("strength", [](const CustomRod& rod) { return std::isfinite(rod.strength); });
  note("second_moment", [](const CustomRod& rod) { return rod.second_moment > 0.0; });
}

}  // namespace

bool gives_in_motion(const RodMaterial& all, const CustomRod& rod) {
  return rod.elastic.value_or(all.rod_model == "elastic");
}

std::string group_name(const CustomRod& rod) {
  return rod.group.empty() ? CustomRod{}.group : rod.group;
}

std::string rod_name(const CustomRod& rod) {
  if (!rod.name.empty() || rod.nodes.size() != 2) return rod.name;
  return rod.nodes[0] + "-" + rod.nodes[1];
}

Structure build_custom(const CustomSpec& spec) {
  if (const auto problems = check_custom(spec); !problems.empty()) {
    const auto& first = problems.front();
    const std::string place =
        first.index < 0 ? first.table : first.table + "[" + std::to_string(first.index) + "]";
    throw StructureError(first.key.empty() ? place : place + "." + first.key, first.message);
  }
  Structure structure;
  structure.kind = "custom";
  structure.lumped_mass = spec.lumped_mass;
  add_nodes(spec, structure);

  NameIndex names;
  for (const auto& node : spec.nodes) names.add(node.name);
  std::vector<long> segments;
  for (const auto& entry : spec.rods) {
    const int a = names.find(entry.nodes[0]), b = names.find(entry.nodes[1]);
    const double apart =
        (spec.nodes[static_cast<std::size_t>(b)].position - spec.nodes[static_cast<std::size_t>(a)].position)
            .norm();
    const double length = entry.length > 0.0 ? entry.length : apart;
    const double material = entry.free_length > 0.0 ? entry.free_length : length;
    structure.rods.push_back(
        {rod_name(entry), a, b, rod_mass(entry, material), length, group_name(entry), 0.0, 1.0});
    if (entry.area > 0.0) give_section(spec, entry, structure.rods.back());
    segments.push_back(segments_of(spec.material, entry, structure.rods.back()));
  }
  if (spec.material.rod_model == "quasi-static") {
    structure.quasi_static =
        std::ranges::any_of(structure.rods, [](const Rod& rod) { return rod.elastic() && !rod.gives; });
    if (!structure.quasi_static)
      structure.notes.push_back(
          "rod_model = \"quasi-static\" does nothing: all rods with a youngs_modulus have elastic = true");
  }
  show_as_solved(structure);
  note_idle_material(structure, spec.material);
  note_idle_sections(spec, structure);
  add_length_errors(structure, spec.material);
  cut_rods(structure, segments);
  return structure;
}

}  // namespace unfurl
