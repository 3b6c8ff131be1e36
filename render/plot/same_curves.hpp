// SPDX-License-Identifier: BSD-3-Clause
// Curves that lie on each other, of which a picture shows the last one.
#pragma once

#include <string>

#include "render/plot/figure.hpp"

namespace unfurl::plot {

// " A, B and C lie on each other." for the labelled curves of a panel that differ by less than a line's width
// everywhere, of several panels followed by which quantities; nothing where there are none. A curve without a
// label has that of the one that looks alike, in whichever panel (a key). A leading blank.
std::string same_curves_sentence(const Figure& figure);

}  // namespace unfurl::plot
