// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

namespace unfurl {

// The colours of the panel beside ImGui's own.
struct Theme {
  bool dark = false;
  ImVec4 window, text, dim, accent, warning, error, rule;
  ImVec4 curve_a, curve_b;  // of the comparison
};

// Sets ImGui's style of the current context: colours, and sizes times `scale`.
Theme apply_theme(bool dark, float scale);

}  // namespace unfurl
