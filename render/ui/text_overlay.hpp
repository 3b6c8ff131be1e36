#pragma once

#include <memory>
#include <vector>

#include "render/scene/draw_list.hpp"

namespace unfurl {

// Writes labels over the bound framebuffer. Needs a current GlContext throughout.
class TextOverlay {
 public:
  TextOverlay();
  ~TextOverlay();
  void draw(const std::vector<TextLabel>& labels, int width, int height);

 private:
  struct Fonts;
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace unfurl
