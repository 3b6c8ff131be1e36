// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/scene_variation.hpp"

#include <algorithm>

#include "core/scene/reader.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

Scene SceneSource::read(const std::vector<std::string>& changes) const {
  std::vector<std::string> all = overrides;
  all.insert(all.end(), changes.begin(), changes.end());
  return text ? read_scene_text(*text, path, all, folder) : read_scene_file(path, all);
}

SolverOptions study_solver(const Scene& scene, const std::vector<std::string>& varied,
                           const std::vector<RunMeasure>& measures) {
  SolverOptions options = scene.solver;
  if (scene.locations.contains("solver.model")) return options;
  const bool method = std::any_of(varied.begin(), varied.end(),
                                  [](const std::string& key) {
                                    return key.starts_with("solver.") && key != "solver.end_time" &&
                                           key != "solver.at_deployed";
                                  }) ||
                      std::any_of(measures.begin(), measures.end(), [](const RunMeasure& measure) {
                        return measure.needs == MeasureNeeds::method;
                      });
  options.model = method ? "full" : "auto";
  return options;
}

namespace {

// What stands at a dotted key of the scene written out, where every parameter has the form of its kind.
std::optional<TomlTree> value_at(const Scene& scene, const std::string& key) {
  const TomlTree root = parse_toml(scene_text(scene), scene.name);
  const TomlTree* at = &root;
  for (std::size_t begin = 0; at && begin <= key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    at = at->kind == TomlTree::Kind::table ? at->find(std::string_view(key).substr(begin, end - begin))
                                           : nullptr;
    begin = end + 1;
  }
  return at ? std::optional(*at) : std::nullopt;
}

}  // namespace

std::optional<double> scene_number(const Scene& scene, const std::string& key) {
  const auto at = value_at(scene, key);
  if (at && at->kind == TomlTree::Kind::real) return at->real;
  if (at && at->kind == TomlTree::Kind::integer) return static_cast<double>(at->integer);
  return std::nullopt;
}

bool is_whole_number(const Scene& scene, const std::string& key) {
  const auto at = value_at(scene, key);
  return at && at->kind == TomlTree::Kind::integer;
}

}  // namespace unfurl
