// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/panes/themed_canvas.hpp"

#include <algorithm>

namespace unfurl {

namespace {

constexpr FigureColor dark_paper{0.145f, 0.172f, 0.204f, 1};

}  // namespace

ImVec4 figure_paper(bool dark) {
  return dark ? ImVec4(dark_paper.r, dark_paper.g, dark_paper.b, 1) : ImVec4(1, 1, 1, 1);
}

// Greys change places, white becoming the dark paper; hues keep theirs and become as light as they were dark.
FigureColor ThemedCanvas::themed(FigureColor c) const {
  if (!dark_) return c;
  const float lightness = 0.5f * (std::max({c.r, c.g, c.b}) + std::min({c.r, c.g, c.b}));
  const float shift = 1 - 2 * lightness;  // the same hue and saturation at the mirrored lightness
  const auto lifted = [&](float part, float paper) {
    const float mirrored = std::clamp(part + shift, 0.0f, 1.0f);
    return paper + (0.96f - paper) * mirrored;
  };
  return {lifted(c.r, dark_paper.r), lifted(c.g, dark_paper.g), lifted(c.b, dark_paper.b), c.a};
}

}  // namespace unfurl
