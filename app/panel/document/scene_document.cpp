// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/scene_document.hpp"

#include <algorithm>
#include <filesystem>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"

namespace unfurl {

SceneDocument open_document(const std::string& scene, std::vector<std::string> overrides) {
  SceneDocument document;
  document.path = find_scene(scene);
  document.name = document.path;
  const TextFile file = read_text_file(document.path, TextSource::pipe_too);
  if (!file.error.empty()) throw UnreadableScene("cannot read scene " + document.path + ": " + file.error);
  document.text = std::make_shared<const std::string>(file.text);
  document.folder = std::filesystem::path(document.path).parent_path().string();
  if (document.folder.empty()) document.folder = ".";
  document.overrides = std::move(overrides);
  // What came through a pipe cannot be read again, and nothing can be saved there.
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(document.path, unknown)) document.path.clear();
  return document;
}

SceneDocument document_of_family(const std::string& kind) {
  for (const LibraryScene& row : library_scenes()) {
    try {
      if (read_scene_file(row.path).kind == kind) return open_document(row.path, {});
    } catch (const std::exception&) {  // a broken scene of the library is no reason to refuse the others
    }
  }
  SceneDocument document;
  document.name = "untitled";
  document.text = std::make_shared<const std::string>("title = " + toml_string(kind) +
                                                      "\n\n[structure]\nkind = " + toml_string(kind) + "\n");
  return document;
}

SceneDocument blank_document() {
  SceneDocument document;
  document.name = "untitled";
  document.text = std::make_shared<const std::string>(
      "title = \"Untitled\"\n\n[structure]\nkind = \"custom\"\n\n"
      "[[structure.nodes]]\nname = \"A\"\nposition = [0, 0, 0]\nfixed = true\n\n"
      "[[structure.nodes]]\nname = \"B\"\nposition = [1, 0, 0]\n\n"
      "[[structure.rods]]\nnodes = [\"A\", \"B\"]\nmass = 1.0\n\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n\n[solver]\nend_time = 2.0\n");
  return document;
}

bool of_library(const std::string& path) {
  const auto scenes = library_scenes();
  return std::any_of(scenes.begin(), scenes.end(), [&](const auto& scene) { return scene.path == path; });
}

SceneDocument simulated_part(SceneDocument document) {
  std::erase_if(document.edits, [](const auto& edit) { return edit.first.starts_with("render."); });
  std::erase_if(document.added, [](const std::string& text) { return text.starts_with("render."); });
  return document;
}

bool is_edited(const SceneDocument& document) {
  return !document.edits.empty() || !document.added.empty();
}

SceneDocument without_edits(SceneDocument document) {
  document.edits.clear();
  document.added.clear();
  return document;
}

std::vector<std::string> overrides_of(const SceneDocument& document) {
  std::vector<std::string> all = document.overrides;
  all.insert(all.end(), document.added.begin(), document.added.end());
  for (const auto& [key, value] : document.edits) all.push_back(key + "=" + toml_value(value));
  return all;
}

Scene read_document(const SceneDocument& document) {
  return read_scene_text(*document.text, document.name, overrides_of(document), document.folder);
}

Scene base_scene(const SceneDocument& document) {
  SceneDocument base = document;
  base.edits.clear();
  return read_document(base);
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string proposed_file(const SceneDocument& document) {
  if (!document.path.empty() && !of_library(document.path)) return document.path;
  return std::filesystem::path(document.name).stem().string() + ".toml";
}

std::string command_line(const SceneDocument& document, const std::string& verb, const std::string& output) {
  std::string scene = document.path.empty() ? proposed_file(document) : document.path;
  for (const LibraryScene& row : library_scenes())  // by its name, which works everywhere
    if (row.path == document.path) scene = row.name;
  std::string line = "unfurl " + verb + " " + shell_word(scene) + " -o " + shell_word(output);
  for (const std::string& text : overrides_of(document)) line += " --set " + shell_word(text);
  return line;
}

}  // namespace unfurl
