// SPDX-License-Identifier: BSD-3-Clause
// Where fonts are.
#pragma once

#include <string>

namespace unfurl {

// The file of a font, given where Debian has it: there, or of that name below $UNFURL_FONTS, fonts/ of the
// program's own assets, the user's fonts or the system's, the first that is there. Empty: none is.
std::string found_font(const std::string& file);

// The program's typeface: DejaVu Sans. Empty where it is nowhere.
std::string font_file(bool bold = false);

}  // namespace unfurl
