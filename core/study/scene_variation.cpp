// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/scene_variation.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/scene/build.hpp"
#include "core/scene/overrides.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"

namespace unfurl {
namespace {

constexpr std::string_view of_variables = "variables.";

}  // namespace

Scene SceneSource::read(const std::vector<std::string>& changes) const {
  std::vector<std::string> all = overrides;
  all.insert(all.end(), changes.begin(), changes.end());
  const FilesBeside::InUse as_they_were(files.get());
  return text ? read_scene_text(*text, path, all, folder) : read_scene_file(path, all);
}

SceneSource scene_source(const std::string& path, const std::vector<std::string>& overrides) {
  SceneSource source{path, overrides};
  TextFile file = read_text_file(path, TextSource::pipe_too);
  if (!file.error.empty()) throw UnreadableScene("cannot read scene " + path + ": " + file.error);
  source.text = std::make_shared<const std::string>(std::move(file.text));
  source.folder = std::filesystem::path(path).parent_path().string();
  if (source.folder.empty()) source.folder = ".";
  source.files = std::make_shared<FilesBeside>();
  return source;
}

SceneSource valid_source(const SceneSource& source, const std::vector<std::vector<std::string>>& points) {
  try {
    build_model(source.read());
    return source;
  } catch (const SceneError&) {
    for (const auto& changes : points) try {
        build_model(source.read(changes));
        SceneSource out = source;
        out.overrides.insert(out.overrides.end(), changes.begin(), changes.end());
        return out;
      } catch (const SceneError&) {  // the next one, then
      }
    throw;
  }
}

namespace {

std::string plain_value(const TomlTree& tree) {
  using Kind = TomlTree::Kind;
  std::string text;
  switch (tree.kind) {
    case Kind::boolean:
      return tree.boolean ? "true" : "false";
    case Kind::integer:
      return toml_value(tree.integer);
    case Kind::real:
      return toml_value(tree.real);
    case Kind::text:
    case Kind::time:
      return toml_string(tree.text);
    case Kind::array:
      for (const TomlTree& item : tree.items) text += (text.empty() ? "" : ", ") + plain_value(item);
      return "[" + text + "]";
    case Kind::table:
      for (const auto& [name, value] : tree.entries)
        text += (text.empty() ? "" : ", ") + toml_string(name) + " = " + plain_value(value);
      return "{" + text + "}";
  }
  return text;
}

}  // namespace

std::string unexpanded_text(const SceneSource& source) {
  const TextFile file = source.text ? TextFile{source.path, *source.text, ""} : read_text_file(source.path);
  if (!file.error.empty()) throw UnreadableScene("cannot read scene " + source.path + ": " + file.error);
  std::string text;
  for (const auto& [name, value] : parse_toml(file.text, source.path).entries)
    text += "# " + toml_string(name) + " = " + plain_value(value) + "\n";
  for (const std::string& change : source.overrides) text += "# --set " + toml_string(change) + "\n";
  return text;
}

SolverOptions study_solver(const Scene& scene, const std::vector<std::string>& varied,
                           const std::vector<RunMeasure>& measures) {
  SolverOptions options = scene.solver;
  if (scene.locations.contains("solver.model") && options.model != "auto") return options;
  if (std::ranges::find(varied, "solver.model") != varied.end()) return options;
  const auto of_method = [](const std::string& key) {
    return key.starts_with("solver.") && key != "solver.end_time" && key != "solver.at_deployed";
  };
  const bool by_variables = std::ranges::any_of(scene.worked_out, of_method);
  const bool method = std::any_of(varied.begin(), varied.end(),
                                  [&](const std::string& key) {
                                    return of_method(key) || (by_variables && key.starts_with(of_variables));
                                  }) ||
                      std::any_of(measures.begin(), measures.end(), [](const RunMeasure& measure) {
                        return measure.needs == MeasureNeeds::method;
                      });
  options.model = method ? "full" : "auto";
  return options;
}

namespace {

// Written out, where every parameter has the form of its kind.
TomlTree value_in(const Scene& scene, const std::string& key) {
  return value_at(parse_toml(scene_text(scene), scene.name), key);
}

}  // namespace

bool keys_overlap(const Scene& scene, const std::string& a, const std::string& b) {
  const TomlTree tree = parse_toml(scene_text(scene), scene.name);
  const auto one = place_of_key(tree, a), two = place_of_key(tree, b);
  return std::equal(one.begin(), one.begin() + static_cast<std::ptrdiff_t>(std::min(one.size(), two.size())),
                    two.begin());
}

std::optional<double> scene_number(const Scene& scene, const std::string& key) {
  if (key.starts_with(of_variables)) {
    const auto found = scene.variables.find(key.substr(of_variables.size()));
    return found == scene.variables.end() ? std::nullopt : std::optional(found->second);
  }
  const TomlTree at = value_in(scene, key);
  if (at.kind == TomlTree::Kind::real) return at.real;
  if (at.kind == TomlTree::Kind::integer) return static_cast<double>(at.integer);
  return std::nullopt;
}

std::string other_than_number(const Scene& scene, const std::string& key) {
  if (key.starts_with(of_variables) || scene_number(scene, key)) return "";
  const TomlTree at = value_in(scene, key);
  return at.kind == TomlTree().kind ? "" : at.describe();
}

bool is_whole_number(const Scene& scene, const std::string& key) {
  return value_in(scene, key).kind == TomlTree::Kind::integer;
}

}  // namespace unfurl
