// SPDX-License-Identifier: BSD-3-Clause
// `--set key=value`: changes to a scene before it is checked.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scene/toml_tree.hpp"

namespace unfurl {

// Each override is "key=value". The key is dotted; an entry of an array goes by its index or, in an array of
// tables, by its name: structure.nodes[0].mass, structure.nodes.B0.mass; a name with dots goes in quotes. The
// value is TOML; a bare word is a string. Missing tables are made. The index behind the last entry of
// [[loads]], [[forces]] or [[constraints]] adds one: constraints[0]={kind="angle", fold_angle=true}; other
// arrays do not grow. What cannot be applied is added to `problems`.
void apply_overrides(TomlTree& root, const std::vector<std::string>& overrides,
                     std::vector<SceneProblem>& problems);

// Where the "=" of "key=value" is: names in brackets or quotes may have one of their own. npos: there is
// none.
std::size_t equals_of(std::string_view text);

// Of a list whose entries stand in a CSV file, too, NAME_file = `file`: what is said where a key leads to
// none of its own. Empty: there is no such file.
std::string entries_in_file(const std::string& name, const TomlTree* file);

// Where such a key leads, part by part, entries by their index; the same for all of its names.
std::vector<std::string> place_of_key(TomlTree root, const std::string& key);

// What stands at such a key; an empty table where nothing does.
TomlTree value_at(TomlTree root, const std::string& key);

}  // namespace unfurl
