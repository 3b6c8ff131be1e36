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

// Rectangles that cover the same and do not overlap: of two that do, one that holds both where it is hardly
// larger, else the other's rest. The last one is not cut: it is whole in one of them.
std::vector<plot::Rect> apart(std::vector<plot::Rect> rects);

}  // namespace unfurl
