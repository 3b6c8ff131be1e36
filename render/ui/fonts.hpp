// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

namespace unfurl {

// Add the program's typeface at a size to an atlas: DejaVu Sans with Latin, Greek, minus, superscripts and
// arrows, or ImGui's built-in font (plain Latin) where that is not installed. `pixels` is the height of a
// line; draw at the size that was asked for, as scaling an atlas blurs it.
ImFont* add_font(ImFontAtlas& atlas, float pixels, bool bold = false);
// The same size of plot::typeface(), with what that has not in DejaVu Sans; both must be installed.
ImFont* add_plot_font(ImFontAtlas& atlas, float pixels);

}  // namespace unfurl
