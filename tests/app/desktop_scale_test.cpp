// SPDX-License-Identifier: BSD-3-Clause
#include "app/window/desktop_scale.hpp"

#include <catch2/catch.hpp>

using namespace unfurl;

namespace desktop_scale_test {

TEST_CASE("the desktop's dots per inch are read from the X server's resources") {
  CHECK(xft_dpi("Xft.antialias:\t1\nXft.dpi:\t192\nXft.hinting:\t1\n") == 192);
  CHECK(xft_dpi("Xft.dpi: 120.5") == 120.5);
  CHECK(xft_dpi("") == 0);
  CHECK(xft_dpi("Xft.dpi:") == 0);
  CHECK(xft_dpi("Xft.dpi: fine\n") == 0);
  CHECK(xft_dpi("old.Xft.dpi: 192\n") == 0);
}

TEST_CASE("the scale goes by quarters, is never below 1, and follows finer pixels") {
  CHECK(scale_for(96, 1) == 1);
  CHECK(scale_for(192, 1) == 2);
  CHECK(scale_for(163, 1) == 1.75f);  // a screen of 27 inches with 3840 x 2160 pixels
  CHECK(scale_for(72, 1) == 1);
  CHECK(scale_for(0, 1.5f) == 1.5f);
  CHECK(scale_for(5000, 2) == 2);  // nonsense
  CHECK(scale_for(96, 2) == 2);
}

}  // namespace desktop_scale_test
