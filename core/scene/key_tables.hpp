// SPDX-License-Identifier: BSD-3-Clause
// Every table of a scene file with its keys, as declared where they are read: what `unfurl list keys`, the
// page docs/scene.md and `unfurl new` show.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/text/param_spec.hpp"

namespace unfurl {

struct KeyTable {
  std::string name;    // "solver", "structure.hoop", "forces.spring"
  std::string header;  // as in a file: "[solver]", "[[forces]]"; empty: the keys before the first table
  std::string help;
  std::vector<ParamSpec> keys;
};

// In the order of a scene file.
const std::vector<KeyTable>& key_tables();

// The table of that name, those whose names begin with it ("forces"), or else end with it ("spring").
std::vector<const KeyTable*> find_key_tables(std::string_view name);

// The type of a value in one word: "number", "whole number", "list", "text", "choice", "switch", "names".
std::string_view type_text(const ParamSpec& spec);

// The default in words: "0.01", "none", "as built".
std::string default_text(const ParamSpec& spec);

// Keys of the tables that have no other home.
const std::vector<ParamSpec>& scene_params();    // before the first table
const std::vector<ParamSpec>& gravity_params();  // [gravity]
const std::vector<ParamSpec>& load_params();
const std::vector<ParamSpec>& deployment_params();  // [[loads]], beside its nodes

}  // namespace unfurl
