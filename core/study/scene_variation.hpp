// SPDX-License-Identifier: BSD-3-Clause
// A scene with some of its keys changed, again and again.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics/measures.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/text_file.hpp"
#include "core/simulate/trajectory.hpp"

namespace unfurl {

// Where the scene comes from: its file, or a text that is called `path`, and the overrides of the command
// line.
struct SceneSource {
  std::string path;
  std::vector<std::string> overrides = {};
  std::shared_ptr<const std::string> text = nullptr;  // null: read the file
  std::string folder = "";                            // of a text: where files lie that it names
  std::shared_ptr<FilesBeside> files = nullptr;       // those, as they were when they were read first

  // With these "key=value" behind the overrides. Throws SceneError, UnreadableScene.
  Scene read(const std::vector<std::string>& changes = {}) const;
};

// Of a path as a person gave it, read now: a file that is edited while its study runs is another scene. So
// are files that it names, which are read with its first point. Throws UnreadableScene.
SceneSource scene_source(const std::string& path, const std::vector<std::string>& overrides);

// The same where it makes a model as it stands; else behind the first of these changes with which it does,
// as all of its points change those keys again. Throws what is wrong with it as it stands where none does.
SceneSource valid_source(const SceneSource& source, const std::vector<std::vector<std::string>>& points);

// What a scene says before its variables are worked out, without comments and layout, and the overrides: as
// comments of TOML. Two scenes that agree in it agree whatever the values of their variables, which two that
// agree once they are worked out need not.
std::string unexpanded_text(const SceneSource& source);

// The solver of a scene of which many are run: its model is "auto" where the scene says that or nothing, but
// "full" where a key that is varied, or a measure, is about the method itself; a model that is varied is that
// of its point. Written out with the scene it makes the same numbers again.
SolverOptions study_solver(const Scene& scene, const std::vector<std::string>& varied,
                           const std::vector<RunMeasure>& measures);

// The number at a dotted key, written out in the scene or a default, or of a variable; nothing where there is
// none.
std::optional<double> scene_number(const Scene& scene, const std::string& key);
// Do two keys lead to the same place, by whatever name, or one of them into the other?
bool keys_overlap(const Scene& scene, const std::string& a, const std::string& b);
// What stands at a key that is no number, as "the text 'full'"; empty where there is a number, or nothing.
std::string other_than_number(const Scene& scene, const std::string& key);
// Is that a parameter of whole numbers (which cannot be searched, nor lie between two of them)?
bool is_whole_number(const Scene& scene, const std::string& key);

}  // namespace unfurl
