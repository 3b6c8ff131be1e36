// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace unfurl {

// The program's typeface on disk: DejaVu Sans, of Debian's fonts-dejavu-core.
constexpr const char* font_file(bool bold = false) {
  return bold ? "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
              : "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
}

}  // namespace unfurl
