// SPDX-License-Identifier: BSD-3-Clause
#include "app/window/window.hpp"

namespace unfurl {

std::string no_window_message(const std::string& cause) {
  return "cannot open a window: " + cause + "; `unfurl render SCENE -o DIR` makes the pictures without one";
}

}  // namespace unfurl
