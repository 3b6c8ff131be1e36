// SPDX-License-Identifier: BSD-3-Clause
// The one place where the program meets a desktop. A backend is another .cpp, chosen by CMake.
#pragma once

#include <memory>
#include <string>

#include "app/panel/document/scene_document.hpp"

namespace unfurl {

struct WindowOptions {
  float ui_scale = 0;  // 0: the monitor's
  bool dark = false;   // else as it was left the last time
  double at = 0;       // of the motion, at first [s]
  std::string record;  // a file for the session (panel/session_log.hpp); empty: none
  bool bench = false;  // no person: measure (panel_bench.hpp), print, close
};

// Shows the panel in a window until it is closed. Returns an ExitCode. Throws GraphicsError where there is no
// display.
int show_window(SceneDocument document, const WindowOptions& options);

// Does the environment name a display?
bool display_named();

// What to say where no window can be had, and why.
std::string no_window_message(const std::string& cause);

}  // namespace unfurl
