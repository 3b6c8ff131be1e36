// SPDX-License-Identifier: BSD-3-Clause
// How large the desktop wants things.
#pragma once

#include <string_view>

namespace unfurl {

// The number of the line "Xft.dpi: 192" of an X server's resources, which desktops set to what their user
// chose; 0: there is none.
double xft_dpi(std::string_view resources);

// Dots per inch of the X server that DISPLAY names; 0: not to be had. The X library is opened for this and
// closed again.
struct X11Dpi {
  double chosen = 0;  // Xft.dpi
  double screen = 0;  // by the size that the server was told of its screen; 96 where nobody told it
};
X11Dpi x11_dpi();

// Pixels per point, 1 at 96 dpi, in quarters and never below 1 nor `pixels_per_unit` of the window; 0 dpi:
// the latter.
float scale_for(double dpi, float pixels_per_unit);

}  // namespace unfurl
