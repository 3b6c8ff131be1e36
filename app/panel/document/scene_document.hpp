// SPDX-License-Identifier: BSD-3-Clause
// The scene that the panel shows: a file's text, and what was changed since, as `--set` would change it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace unfurl {

inline std::vector<double> numbers(const Vec3& v) {  // as an edit has them
  return {v[0], v[1], v[2]};
}

// Plain data; two that are equal mean the same scene.
struct SceneDocument {
  std::string path;    // of the file; empty: it was never saved, or came through a pipe
  std::string name;    // what messages call it: the path, or "untitled"
  std::string folder;  // where files that the scene names lie
  std::shared_ptr<const std::string> text;
  std::vector<std::string> overrides;       // from the command line
  std::vector<std::string> added;           // entries of lists, from the panel: "forces[0]={...}"
  std::map<std::string, ParamValue> edits;  // from the panel: dotted key -> value, valid or not

  bool operator==(const SceneDocument& o) const {
    return path == o.path && name == o.name && *text == *o.text && overrides == o.overrides &&
           added == o.added && edits == o.edits;
  }
};

// The file or built-in scene of that name. Throws UnreadableScene.
SceneDocument open_document(const std::string& scene, std::vector<std::string> overrides);
// A scene of a family: the library's first one of that kind, or the family's defaults.
SceneDocument document_of_family(const std::string& kind);

// Two nodes and a rod: the least from which a structure can be built by hand.
SceneDocument blank_document();
bool of_library(const std::string& path);  // a scene that comes with the program

// The document without edits that change only pictures: where it is the same, so is the run.
SceneDocument simulated_part(SceneDocument document);

bool is_edited(const SceneDocument& document);  // in the panel
SceneDocument without_edits(SceneDocument document);

// All overrides as "key=value": the command line's, entries added, edits.
std::vector<std::string> overrides_of(const SceneDocument& document);
// The scene that the document means. Throws SceneError.
Scene read_document(const SceneDocument& document);
// The scene without the panel's edits, but with entries that it added: what widgets show where nothing was
// edited. Throws SceneError.
Scene base_scene(const SceneDocument& document);

// The name of a file of its own that is proposed for a document: "untitled.toml".
std::string proposed_file(const SceneDocument& document);
// "unfurl render hoop6 -o out --set solver.step=0.02", quoted for a shell; without a file as if the proposed
// one were there.
std::string command_line(const SceneDocument& document, const std::string& verb, const std::string& output);
std::string shell_word(const std::string& word);

}  // namespace unfurl
