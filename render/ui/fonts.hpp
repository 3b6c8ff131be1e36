// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

#include "render/plot/typeface.hpp"

namespace unfurl {

// Add the program's typeface at a size to an atlas: DejaVu Sans with Latin, Greek, minus, superscripts and
// arrows, or ImGui's built-in font (plain Latin) where that is not installed. `pixels` is the height of a
// line; draw at the size that was asked for, as scaling an atlas blurs it. A window, which has one atlas for
// all that people write into it, has Cyrillic and more of Latin besides.
enum class Letters { pictures, window };
ImFont* add_font(ImFontAtlas& atlas, float pixels, bool bold = false, Letters letters = Letters::pictures);
// The same size of plot::typeface(), with what that has not in DejaVu Sans; both must be installed.
ImFont* add_plot_font(ImFontAtlas& atlas, float pixels);

// Whether each font has that character from the start, if its file has it.
bool is_common(char32_t c);
// Other characters, for a font that was added with this size, weight and typeface: what its file has not is
// DejaVu Sans's, and what that has not is left out. Pairs of first and last, ended by 0, that outlive the
// atlas.
void add_glyphs(ImFontAtlas& atlas, ImFont& font, float pixels, bool bold, const plot::Typeface& face,
                const ImWchar* ranges);

}  // namespace unfurl
