#include "core/study/scene_variation.hpp"

#include "core/scene/reader.hpp"
#include "core/scene/toml_tree.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

Scene SceneSource::read(const std::vector<std::string>& changes) const {
  std::vector<std::string> all = overrides;
  all.insert(all.end(), changes.begin(), changes.end());
  return text ? read_scene_text(*text, path, all, folder) : read_scene_file(path, all);
}

std::optional<double> scene_number(const Scene& scene, const std::string& key) {
  const TomlTree root = parse_toml(scene_text(scene), scene.name);
  const TomlTree* at = &root;
  for (std::size_t begin = 0; at && begin <= key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    at = at->kind == TomlTree::Kind::table ? at->find(std::string_view(key).substr(begin, end - begin))
                                           : nullptr;
    begin = end + 1;
  }
  if (at && at->kind == TomlTree::Kind::real) return at->real;
  if (at && at->kind == TomlTree::Kind::integer) return static_cast<double>(at->integer);
  return std::nullopt;
}

}  // namespace unfurl
