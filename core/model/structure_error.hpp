// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>
#include <utility>

namespace unfurl {

// An impossible structure. `key` names the parameter or member at fault, e.g. "fold_angle" or
// "rods[3].nodes".
struct StructureError : std::exception {
  StructureError(std::string key_, std::string message_)
      : key(std::move(key_)), message(std::move(message_)) {}
  const char* what() const noexcept override { return message.c_str(); }
  std::string key, message;
};

}  // namespace unfurl
