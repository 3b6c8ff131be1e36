// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/library.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/title.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

std::string title_of(const std::string& path) {
  try {
    const TomlTree tree = parse_toml(read_text_file(path).text, path);
    return scene_title(tree, tree, "");
  } catch (const SceneError&) {
    return "";
  }
}

}  // namespace

std::string asset_folder(const std::string& kind) {
  std::error_code error;
  std::vector<fs::path> roots;
  if (const char* assets = std::getenv("UNFURL_ASSETS"); assets && *assets) roots.emplace_back(assets);
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) roots.push_back(program.parent_path().parent_path() / "share" / "unfurl");
  roots.emplace_back(UNFURL_DATA);
  // The source tree that a build lies in.
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    if (fs::exists(folder / "core" / "scene" / "library.hpp", error)) roots.push_back(folder / "assets");
  for (const auto& root : roots)
    if (fs::is_directory(root / kind, error)) return (root / kind).string();
  return "";
}

std::string no_library() {
  return "the scenes that come with Unfurl are not installed beside it; UNFURL_ASSETS may name the folder "
         "that holds scenes/";
}

std::vector<LibraryScene> library_scenes() {
  std::vector<LibraryScene> scenes;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(asset_folder("scenes"), error))
    if (entry.path().extension() == ".toml")
      scenes.push_back(
          {entry.path().stem().string(), entry.path().string(), title_of(entry.path().string())});
  std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scenes;
}

std::string find_scene(const std::string& scene) {
  std::error_code error;
  if (fs::exists(scene, error) && !fs::is_directory(scene, error)) return scene;
  const fs::path built_in = fs::path(asset_folder("scenes")) / (scene + ".toml");
  if (scene.find('/') == std::string::npos && fs::is_regular_file(built_in, error)) return built_in.string();
  const auto scenes = library_scenes();
  std::vector<std::string_view> names;
  for (const auto& row : scenes) {
    if (row.name == scene) return row.path;
    names.push_back(row.name);
  }
  if (fs::is_directory(scene, error)) {
    const std::string own = (fs::path(scene) / "scene.toml").string();
    throw UnreadableScene("cannot read scene " + scene + ": is a directory" +
                          (fs::exists(own, error) ? ", whose scene is " + own : ""));
  }
  const bool is_path = scene.find('/') != std::string::npos || scene.ends_with(".toml");
  if (is_path) throw UnreadableScene("cannot read scene " + scene + ": no such file");
  if (names.empty()) throw UnreadableScene("no file " + in_quotes(scene) + ", and " + no_library());
  throw UnreadableScene("no scene " + in_quotes(scene) + ", neither a file nor a built-in one" +
                        did_you_mean(scene, names));
}

}  // namespace unfurl
