// SPDX-License-Identifier: BSD-3-Clause
// Where fonts are.
#pragma once

#include <string>
#include <string_view>

namespace unfurl {

// The bytes of a font, given by the file where Debian has it: those that the program was built with (DejaVu
// Sans, UNFURL_EMBED_FONTS: pictures do not depend on what a machine has), or of that file, or of the first
// of that name below $UNFURL_FONTS, the user's fonts or the system's. Empty: there is none. They stay while
// the program runs.
std::string_view font_bytes(const std::string& file);

// The program's typeface: DejaVu Sans. Empty where it was built without and it is nowhere.
std::string_view own_font(bool bold = false);
bool own_font_has(char32_t c);  // true where there is no such font to ask

}  // namespace unfurl
