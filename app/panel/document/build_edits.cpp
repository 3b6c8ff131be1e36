// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/build_edits.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/write.hpp"

namespace unfurl {

namespace {

constexpr double same_place = 1e-6;  // [m]

Scene built_scene(const SceneDocument& document) {
  Scene scene = read_document(document);
  const auto refuse = [](const char* why) { throw SceneError({{{"", 0, 0}, "structure", why}}); };
  if (scene.kind != "custom")
    refuse(
        "only a custom structure is built by hand: a family's nodes follow from its parameters (Open, New)");
  if (scene.locations.contains("structure.nodes_file") || scene.locations.contains("structure.rods_file"))
    refuse("its nodes or rods are in CSV files; those are edited there");
  return scene;
}

// A place that was pointed at.
Vec3 rounded(Vec3 v) {
  for (double& x : v) x = std::round(x * 1e9) / 1e9 + 0.0;
  return v;
}

std::string node_key(std::size_t i) {
  return "structure.nodes[" + std::to_string(i) + "]";
}

const CustomNode* find_node(const CustomSpec& spec, const std::string& name) {
  const auto at =
      std::find_if(spec.nodes.begin(), spec.nodes.end(), [&](const CustomNode& n) { return n.name == name; });
  return at == spec.nodes.end() ? nullptr : &*at;
}

template <class Parts>
std::string list_text(const Parts& parts) {
  std::string list;
  for (const auto& part : parts) list += (list.empty() ? "" : ", ") + inline_text(part);
  return "[" + list + "]";
}

// Both lists said anew: what was said of single entries is in them.
SceneDocument with_lists(SceneDocument document, const CustomSpec& spec) {
  const auto of_lists = [](const std::string& text) {
    return text.starts_with("structure.nodes") || text.starts_with("structure.rods");
  };
  std::erase_if(document.added, of_lists);
  std::erase_if(document.edits, [&](const auto& edit) { return of_lists(edit.first); });
  document.added.push_back("structure.nodes=" + list_text(spec.nodes));
  document.added.push_back("structure.rods=" + list_text(spec.rods));
  return document;
}

}  // namespace

Vec3 snapped(Vec3 point, const BuildGrid& grid) {
  for (Index i = 0; i < 3; ++i)
    if (grid.step > 0 && i != grid.plane) point[i] = grid.step * std::round(point[i] / grid.step) + 0.0;
  return point;
}

Vec3 mirrored(Vec3 point, int axis) {
  if (axis >= 0) point[axis] = -point[axis];
  return point;
}

std::vector<Vec3> places_of(const Structure& structure) {
  std::vector<Vec3> places;
  for (const Node& node : structure.nodes)
    if (!node.ghost) places.push_back(node.position);
  return places;
}

bool in_plane_across(int axis, const std::vector<Vec3>& places) {
  return !places.empty() && std::ranges::all_of(places, [&](const Vec3& place) {
    return std::abs(place[axis] - places.front()[axis]) < 1e-9;
  });
}

SceneDocument with_node(const SceneDocument& document, const Vec3& position, std::string& name) {
  const Scene scene = built_scene(document);
  for (int i = 1; name.empty() || find_node(scene.custom, name) != nullptr; ++i)
    name = "N" + std::to_string(i);
  SceneDocument with = document;
  CustomNode node;
  node.name = name;
  node.position = rounded(position);
  node.mass = 1;  // what hangs on nothing must have some
  with.added.push_back(node_key(scene.custom.nodes.size()) + "=" + inline_text(node));
  return with;
}

SceneDocument with_rod(const SceneDocument& document, const std::string& a, const std::string& b) {
  const Scene scene = built_scene(document);
  for (const CustomRod& rod : scene.custom.rods)
    if ((rod.nodes[0] == a && rod.nodes[1] == b) || (rod.nodes[0] == b && rod.nodes[1] == a)) return document;
  SceneDocument with = document;
  CustomRod rod;
  rod.nodes = {a, b};
  rod.mass = 1;
  with.added.push_back("structure.rods[" + std::to_string(scene.custom.rods.size()) +
                       "]=" + inline_text(rod));
  return with;
}

SceneDocument with_positions(const SceneDocument& document, const std::vector<NodePlace>& places,
                             bool follow) {
  Scene scene = built_scene(document);
  SceneDocument with = document;
  auto& nodes = scene.custom.nodes;
  for (const NodePlace& place : places)
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].name == place.name) {
        nodes[i].position = place.position;
        with.edits[node_key(i) + ".position"] = numbers(rounded(place.position));
      }
  for (std::size_t i = 0; follow && i < scene.custom.rods.size(); ++i) {
    const CustomRod& rod = scene.custom.rods[i];
    const CustomNode *a = find_node(scene.custom, rod.nodes[0]), *b = find_node(scene.custom, rod.nodes[1]);
    const bool moved = std::any_of(places.begin(), places.end(), [&](const NodePlace& place) {
      return place.name == rod.nodes[0] || place.name == rod.nodes[1];
    });
    if (moved && rod.length > 0 && a && b)
      with.edits["structure.rods[" + std::to_string(i) + "].length"] =
          std::round((b->position - a->position).norm() * 1e9) / 1e9;
  }
  return with;
}

SceneDocument without_part(const SceneDocument& document, const Selection& part) {
  CustomSpec spec = built_scene(document).custom;
  const std::size_t before = spec.nodes.size() + spec.rods.size();
  if (part.kind == Selection::Kind::node) {
    std::erase_if(spec.nodes, [&](const CustomNode& node) { return node.name == part.name; });
    std::erase_if(spec.rods, [&](const CustomRod& rod) {
      return rod.nodes[0] == part.name || rod.nodes[1] == part.name;
    });
  } else {
    std::erase_if(spec.rods, [&](const CustomRod& rod) { return rod_name(rod) == part.name; });
  }
  if (spec.nodes.size() + spec.rods.size() == before) return document;  // it has no such part
  return with_lists(document, spec);
}

std::string node_at(const Scene& scene, const Vec3& place) {
  for (const CustomNode& node : scene.custom.nodes)
    if ((node.position - place).norm() < same_place) return node.name;
  return "";
}

}  // namespace unfurl
