// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace unfurl {

// Of groups of rods on a pale ground, in pictures and in figures [sRGB, 0..1]: blue, orange, bluish green,
// reddish purple, sky blue, vermilion (Okabe and Ito 2008, darkened).
inline constexpr std::array<std::array<float, 3>, 6> group_colors_on_pale{{{0.00f, 0.37f, 0.66f},
                                                                           {0.88f, 0.50f, 0.02f},
                                                                           {0.00f, 0.55f, 0.40f},
                                                                           {0.72f, 0.38f, 0.58f},
                                                                           {0.25f, 0.62f, 0.85f},
                                                                           {0.80f, 0.30f, 0.00f}}};

}  // namespace unfurl
