// SPDX-License-Identifier: BSD-3-Clause
// A custom scene of what another program wrote: FOLD (origami), OBJ (lines and faces), CSV (nodes and rods).
#pragma once

#include <string>
#include <vector>

#include "core/scene/text_file.hpp"

namespace unfurl {

struct ImportedScene {
  std::string text;                // TOML that runs, with comments
  std::vector<std::string> notes;  // what a person should know
};

// One file whose name ends in .fold or .obj, or two that end in .csv: nodes, then rods. Its edges are rods,
// its faces rigid plates hinged at their edges. Six constraints hold it in space without a force between
// them: its first face or, where it has none, its first three nodes that are not in one line; none where
// nodes are fixed. Throws SceneError with the place and what is allowed there.
ImportedScene import_scene(const std::vector<TextFile>& files);

// "fold", "obj", "csv"; empty: none that can be read.
std::string import_format(const std::string& file);

}  // namespace unfurl
