// SPDX-License-Identifier: BSD-3-Clause
// The table of structure families. To add one: a .hpp/.cpp pair, a row in family.cpp, a scene file.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/structure/structure.hpp"
#include "core/structure/structure_error.hpp"
#include "core/text/param_spec.hpp"

namespace unfurl {

struct Family {
  std::string_view kind;
  std::string_view help;
  const std::vector<ParamSpec>& (*params)();
  // Throws StructureError where the parameters, each fine alone, cannot make a structure.
  Structure (*build)(const ParamSet& params);
  bool deploys;  // has a fold angle and a deployed pose: what its scenes run to where they give no end
};

// Every family with parameters of its own; `custom` is built from a list (custom.hpp) and is not among them.
std::span<const Family> families();
const Family* find_family(std::string_view kind);

}  // namespace unfurl
