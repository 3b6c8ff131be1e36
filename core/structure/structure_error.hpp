// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "core/text/error.hpp"

namespace unfurl {

// An impossible structure. `key` names the parameter or member at fault, e.g. "fold_angle" or
// "rods[3].nodes".
struct StructureError : Error {
  StructureError(std::string key_, std::string message_)
      : Error(message_), key(std::move(key_)), message(std::move(message_)) {}
  std::string key, message;
};

}  // namespace unfurl
