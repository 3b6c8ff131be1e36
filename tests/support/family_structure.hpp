// SPDX-License-Identifier: BSD-3-Clause
// Structures of a family by parameter, for tests.
#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/structure/node_positions.hpp"
#include "core/structures/family.hpp"

namespace unfurl::testing {

using Changes = std::initializer_list<std::pair<const char*, ParamValue>>;

inline ParamSet family_params(std::string_view kind, const Changes& changes = {}) {
  const Family* family = find_family(kind);
  if (!family) throw std::logic_error("no such family");
  ParamSet params(family->params());
  for (const auto& [name, value] : changes) params.set(name, value);
  return params;
}

inline Structure family_structure(std::string_view kind, const Changes& changes = {}) {
  return find_family(kind)->build(family_params(kind, changes));
}

// Empty where the family builds; else the key and the message of what it refuses.
inline std::string refusal(std::string_view kind, const Changes& changes) {
  try {
    family_structure(kind, changes);
    return "";
  } catch (const StructureError& error) {
    return error.key + ": " + error.message;
  }
}

}  // namespace unfurl::testing
