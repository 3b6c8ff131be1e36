// SPDX-License-Identifier: BSD-3-Clause
// What of a picture that Dear ImGui describes is not as it was: only that has to be painted again.
#pragma once

#include <imgui.h>

#include <cstddef>
#include <string>
#include <vector>

#include "render/plot/canvas.hpp"

namespace unfurl {

class DrawDamage {
 public:
  // Rectangles [whole pixels] that hold everything that differs from the last call's data; none overlaps
  // another. All of the picture at first, and where windows changed their order.
  std::vector<plot::Rect> update(const ImDrawData& data);
  void forget() { known_ = false; }

 private:
  struct Seen {  // of a window
    std::string name;
    std::vector<std::byte> content;
    plot::Rect bounds;
  };
  static Seen seen(const ImDrawList& list, const ImDrawData& data);

  bool known_ = false;
  std::vector<Seen> lists_;
  float width_ = 0, height_ = 0;
};

// Those that overlap become one that holds both, until none do.
std::vector<plot::Rect> merged(std::vector<plot::Rect> rects);

}  // namespace unfurl
