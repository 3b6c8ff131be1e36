// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/film_style.hpp"

#include <string_view>
#include <vector>

#include "core/scene/element_members.hpp"
#include "core/scene/scene_error.hpp"
#include "core/text/name_index.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

SourceLocation place_of_key(const Scene& scene, const std::string& key) {
  const auto it = scene.locations.find(key);
  return it == scene.locations.end() ? SourceLocation{scene.name, 0, 0} : it->second;
}

// The inset's column is one that only the run can tell to be there.
void check_inset(const Scene& scene, const Diagnostics& diagnostics) {
  const std::string& inset = scene.render.inset;
  if (inset.empty() || diagnostics.find(inset)) return;
  std::vector<std::string_view> names;
  for (const Series& series : diagnostics.columns) names.push_back(series.name);
  throw SceneError({{place_of_key(scene, "render.inset"), "render.inset",
                     "no column " + in_quotes(inset) + did_you_mean(inset, names)}});
}

std::vector<int> trail_nodes(const Scene& scene, const Structure& structure) {
  const std::string& pattern = scene.render.trails;
  if (pattern.empty()) return {};
  NameIndex nodes;
  for (const NodeCopy& copy : structure.node_copies) nodes.add(copy.name);
  std::vector<int> found = matching_copies(structure, nodes, pattern);
  if (found.empty())
    throw SceneError({{place_of_key(scene, "render.trails"), "render.trails",
                       nodes.matching(pattern).empty()
                           ? "no node matches " + in_quotes(pattern) + did_you_mean(pattern, nodes.names())
                           : only_within_rods(pattern)}});
  return found;
}

}  // namespace

void check_film_names(const Scene& scene, const Structure& structure) {
  trail_nodes(scene, structure);
  shown_surfaces(scene, structure);
}

std::vector<ShownSurface> shown_surfaces(const Scene& scene, const Structure& structure) {
  std::vector<ShownSurface> shown;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i)
    if (const SceneSurface& s = scene.surfaces[i]; s.enabled)
      shown.push_back({s, surface_nodes(s, "surfaces[" + std::to_string(i) + "].nodes", structure)});
  return shown;
}

FrameStyle film_style(const Scene& scene, const Simulation& run, const Diagnostics& diagnostics) {
  const RenderOptions& options = scene.render;
  FrameStyle style;
  style.width = options.width * options.supersample;
  style.height = options.height * options.supersample;
  style.title = scene.title;
  check_inset(scene, diagnostics);
  style.options = options;
  style.trails = trail_nodes(scene, run.trajectory.structure());
  style.surfaces = shown_surfaces(scene, run.trajectory.structure());
  style.run = &run;
  style.diagnostics = &diagnostics;
  return style;
}

}  // namespace unfurl
