// SPDX-License-Identifier: BSD-3-Clause
// unfurl new KIND: a commented scene of a family, or of one's own nodes and rods, to begin from.
#include <iostream>
#include <stdexcept>

#include "app/command.hpp"
#include "core/scene/scene_template.hpp"

namespace unfurl {

int cmd_new(const Arguments& arguments) {
  try {
    std::cout << scene_template(arguments.names.front());
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return exit_ok;
}

}  // namespace unfurl
