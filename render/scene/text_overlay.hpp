// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "render/scene/draw_list.hpp"

namespace unfurl {

// Draws areas, lines and labels over the bound framebuffer. Needs a current GlContext throughout.
class TextOverlay {
 public:
  TextOverlay();
  ~TextOverlay();
  void draw(const DrawList& list, int width, int height);

 private:
  struct Fonts;
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace unfurl
