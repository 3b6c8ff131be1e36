// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/toml_tree.hpp"

namespace unfurl {

const TomlTree* TomlTree::find(std::string_view key) const {
  for (const auto& [name, value] : entries)
    if (name == key) return &value;
  return nullptr;
}

TomlTree* TomlTree::find(std::string_view key) {
  return const_cast<TomlTree*>(static_cast<const TomlTree*>(this)->find(key));
}

std::string TomlTree::describe() const {
  switch (kind) {
    case Kind::boolean:
      return boolean ? "true" : "false";
    case Kind::integer:
      return "the whole number " + std::to_string(integer);
    case Kind::real:
      return "a number";
    case Kind::text:
      return "text";
    case Kind::array:
      return "a list of " + std::to_string(items.size()) + (items.size() == 1 ? " entry" : " entries");
    case Kind::table:
      return "a table";
    case Kind::time:
      return "a date or time";
  }
  return "";
}

}  // namespace unfurl
