// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/surfaces.hpp"

#include <algorithm>

#include "core/scene/element_members.hpp"
#include "core/text/name_index.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

constexpr SurfaceKind kinds[] = {
    {"mesh", "a fine golden knit that lets most of the light through"},
    {"net", "golden cords with nothing between them"},
    {"membrane", "a thin metallised film"},
    {"solar_panel", "cells on a stiff plate, pale at the back"},
    {"paraboloid", "a mesh as a paraboloid of the ring of its nodes; short for a mesh with that shape"},
};

std::vector<std::string_view> kind_names() {
  std::vector<std::string_view> names;
  for (const SurfaceKind& kind : kinds) names.push_back(kind.name);
  return names;
}

}  // namespace

std::span<const SurfaceKind> surface_kinds() {
  return kinds;
}

const std::vector<ParamSpec>& surface_params() {
  static const SceneSurface fallback;
  static const std::vector<ParamSpec> params = {
      choice_param("kind", fallback.kind, kind_names(), "what it is made of; unfurl list surfaces"),
      choice_param("shape", fallback.shape, {"flat", "paraboloid"}, "what is spanned between its nodes"),
      only_with("kind", {"paraboloid"},
                only_with("shape", {"paraboloid"},
                          real_param("focal_ratio", "", fallback.focal_ratio, 0.1, 100,
                                     "of a paraboloid: focal length over diameter of the ring"))),
      only_with("kind", {"mesh", "net", "solar_panel", "paraboloid"},
                integer_param("cells", fallback.cells, 1, 200, "of a net or a panel, from edge to edge")),
      real_param("opacity", "", fallback.opacity, 0, 1,
                 "share of the light that it keeps; 0: the kind's own"),
      boolean_param("enabled", fallback.enabled, "false: as if it were not there")};
  return params;
}

SceneSurface scene_surface(const ParamSet& values) {
  SceneSurface s;
  s.kind = values.text("kind");
  s.shape = s.kind == "paraboloid" ? "paraboloid" : values.text("shape");
  s.focal_ratio = values.real("focal_ratio");
  s.cells = static_cast<int>(values.integer("cells"));
  s.opacity = values.real("opacity");
  s.enabled = values.boolean("enabled");
  return s;
}

ParamSet surface_values(const SceneSurface& s) {
  ParamSet values;
  values.set("kind", s.kind);
  values.set("shape", s.shape);
  values.set("focal_ratio", s.focal_ratio);
  values.set("cells", static_cast<long>(s.cells));
  values.set("opacity", s.opacity);
  values.set("enabled", s.enabled);
  return values;
}

std::vector<int> surface_nodes(const SceneSurface& surface, const std::string& key,
                               const Structure& structure) {
  NameIndex names;
  for (const NodeCopy& copy : structure.node_copies) names.add(copy.name);
  std::vector<int> nodes;
  std::vector<SceneProblem> problems;
  for (const std::string& pattern : surface.nodes) {
    const std::vector<int> found = matching_copies(structure, names, pattern);
    if (found.empty() && !names.matching(pattern).empty())
      problems.push_back({surface.where, key, only_within_rods(pattern)});
    else if (found.empty())
      problems.push_back({surface.where, key,
                          "no node matches " + in_quotes(pattern) + did_you_mean(pattern, names.names())});
    for (const int node : found)
      if (std::ranges::find(nodes, node) == nodes.end()) nodes.push_back(node);
  }
  if (problems.empty() && nodes.size() < 3)
    problems.push_back({surface.where, key, "must be three nodes or more, in order around the edge"});
  if (!problems.empty()) throw SceneError(std::move(problems));
  return nodes;
}

}  // namespace unfurl
