// The table of structure families. To add one: a .hpp/.cpp pair, a row in family.cpp, a scene file.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/model/param_spec.hpp"
#include "core/model/structure.hpp"

namespace unfurl {

struct Family {
  std::string_view kind;
  std::string_view help;
  const std::vector<ParamSpec>& (*params)();
  // Throws StructureError where the parameters, each fine alone, cannot make a structure.
  Structure (*build)(const ParamSet& params);
};

// Every family with parameters of its own; `custom` is built from a list (custom.hpp) and is not among them.
std::span<const Family> families();
const Family* find_family(std::string_view kind);

// An impossible structure. `key` names the parameter or member at fault, e.g. "fold_angle" or "rods[3].nodes".
struct StructureError : std::exception {
  StructureError(std::string key_, std::string message_) : key(std::move(key_)), message(std::move(message_)) {}
  const char* what() const noexcept override { return message.c_str(); }
  std::string key, message;
};

}  // namespace unfurl
