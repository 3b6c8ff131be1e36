// SPDX-License-Identifier: BSD-3-Clause
// Variables, expressions and repeated entries of a scene file, worked out before it is checked:
//
//     [variables]
//     n = 12
//     pitch = "=6/n"                                # an expression is a text that begins with "="
//
//     [[structure.nodes]]
//     repeat = {i = "0:n"}                          # once for i = 0, 1, ..., n - 1; also a list of values
//     name = "B{i}"                                 # braces in a text: the value
//     position = ["=cos(2*pi*i/n)", 0, "=i*pitch"]
//
// With two variables in `repeat` the entry stands once for every pair, the last one running fastest. Braces
// are looked at only in repeated entries and in scenes with [variables]; "{{" is a brace there. The tree that
// is left has neither variables nor expressions.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/scene/scene_error.hpp"
#include "core/scene/toml_tree.hpp"

namespace unfurl {

struct WorkedOut {
  std::map<std::string, double> variables;
  std::set<std::string> keys;                  // dotted keys whose values come of an expression or of braces
  std::map<std::string, SourceLocation> idle;  // variables of which nothing in the scene is worked out
};

// Overrides of the variables are applied first ("variables.n=20", which must be there), then the variables
// are worked out and the tree expanded, then all other overrides applied (overrides.hpp). What is wrong is
// added to `problems`. False: variables, expressions or repeats are wrong, and what else may be told of the
// tree would only follow from that. `worked_out`: to be filled.
bool apply_overrides_and_expand(TomlTree& root, const std::vector<std::string>& overrides,
                                std::vector<SceneProblem>& problems, WorkedOut* worked_out = nullptr);

// Variables on which it depends what files a scene names, by themselves or through others.
std::set<std::string> variables_of_files(TomlTree root, const std::vector<std::string>& overrides);

}  // namespace unfurl
