// SPDX-License-Identifier: BSD-3-Clause
// Where legends and labels hide the least of the data.
#pragma once

#include <vector>

#include "render/plot/canvas.hpp"
#include "render/plot/trace.hpp"

namespace unfurl::plot {

// What is on a panel already: lines that had better stay visible, and texts that must.
class Obstacles {
 public:
  void add_line(Polyline line) { lines_.push_back(std::move(line)); }
  void add_box(const Rect& box) { boxes_.push_back(box); }

  // How much line a box hides [points]; far more where it touches a text.
  double hidden(const Rect& box) const;

 private:
  std::vector<Polyline> lines_;
  std::vector<Rect> boxes_;
};

// More than any length of line on a page.
inline constexpr double touches_text = 1e7;

// The length of the part of a-b inside the box.
double length_inside(Point a, Point b, const Rect& box);

struct Spot {
  Rect box;
  double hidden = 0;
};
// A place for a box of this size in the region: as little hidden as can be, then near a corner, the upper
// right one first. The region must be larger than the box.
Spot free_spot(const Obstacles& obstacles, const Rect& region, double width, double height);

}  // namespace unfurl::plot
