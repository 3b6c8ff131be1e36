// SPDX-License-Identifier: BSD-3-Clause
// A build without SDL2 (cmake -DUNFURL_WINDOW=OFF).
#include "app/window/window.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {

bool display_named() {
  return false;
}

int show_window(SceneDocument, const WindowOptions&) {
  throw GraphicsError(no_window_message("this unfurl was built without one (UNFURL_WINDOW=OFF)"));
}

}  // namespace unfurl
