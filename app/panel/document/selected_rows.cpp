// SPDX-License-Identifier: BSD-3-Clause
// Rows for the node or rod of a custom structure that is selected in the view.
#include <cmath>

#include "app/panel/document/param_rows.hpp"
#include "core/scene/custom_reader.hpp"

namespace unfurl {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

// Entries from a CSV file have no key of their own in the scene.
bool in_scene_file(const Scene& base, const std::string& key) {
  const auto entry = base.locations.find(key), structure = base.locations.find("structure");
  return entry != base.locations.end() && structure != base.locations.end() &&
         entry->second.file == structure->second.file;
}

std::vector<double> three(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

void add_node_row(ParamSection& section, const std::string& key, const ParamSpec& spec,
                  const CustomNode& node) {
  ParamValue value;
  if (spec.name == "position")
    value = three(node.position);
  else if (spec.name == "velocity")
    value = three(node.velocity);
  else if (spec.name == "mass")
    value = node.mass;
  else if (spec.name == "fixed")
    value = node.fixed;
  else
    return;  // its name: others refer to it
  section.rows.push_back(
      {key + "." + std::string(spec.name), std::string(spec.name), spec, std::move(value)});
}

double distance_of(const CustomSpec& spec, const CustomRod& rod) {
  Vec3 ends[2] = {Vec3::Zero(), Vec3::Zero()};
  for (std::size_t k = 0; k < 2; ++k)
    for (const CustomNode& node : spec.nodes)
      if (node.name == rod.nodes[k]) ends[k] = node.position;
  return (ends[1] - ends[0]).norm();
}

void add_rod_row(ParamSection& section, const std::string& key, const ParamSpec& spec, const CustomRod& rod,
                 double distance) {
  ParamRow row{key + "." + std::string(spec.name), std::string(spec.name), spec, missing};
  if (spec.name == "mass") {
    if (rod.mass) row.value = *rod.mass;
    row.typical = 1.0;
  } else if (spec.name == "density" || spec.name == "area") {
    if (rod.mass) return;  // the mass is given
    row.value = spec.name == "area" ? rod.area : rod.density;
  } else if (spec.name == "length") {
    if (rod.length > 0) row.value = rod.length;
    row.typical = distance;
  } else if (spec.name == "group") {
    row.value = rod.group;
  } else {
    return;
  }
  section.rows.push_back(std::move(row));
}

}  // namespace

ParamSection selected_section(const Scene& base, const Selection& selected) {
  ParamSection section;
  const CustomSpec& spec = base.custom;
  for (std::size_t i = 0; selected.kind == Selection::Kind::node && i < spec.nodes.size(); ++i) {
    const std::string key = "structure.nodes[" + std::to_string(i) + "]";
    if (spec.nodes[i].name != selected.name || !in_scene_file(base, key)) continue;
    section.title = "Node " + selected.name;
    for (const ParamSpec& param : custom_node_params()) add_node_row(section, key, param, spec.nodes[i]);
  }
  for (std::size_t i = 0; selected.kind == Selection::Kind::rod && i < spec.rods.size(); ++i) {
    const CustomRod& rod = spec.rods[i];
    const std::string key = "structure.rods[" + std::to_string(i) + "]";
    const std::string name = rod.name.empty() ? rod.nodes.at(0) + "-" + rod.nodes.at(1) : rod.name;
    if (name != selected.name || !in_scene_file(base, key)) continue;
    section.title = "Rod " + name;
    for (const ParamSpec& param : custom_rod_params())
      add_rod_row(section, key, param, rod, distance_of(spec, rod));
  }
  return section;
}

}  // namespace unfurl
