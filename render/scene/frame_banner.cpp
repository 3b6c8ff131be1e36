// SPDX-License-Identifier: BSD-3-Clause
// What is written above pictures that stand side by side.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "render/scene/frame_overlay.hpp"

namespace unfurl {

// Headings on the left set the height, the legend ends on the last one's line; where it would run into them
// or has more rows, the strip is higher by as many. Of what would make it higher than most of a picture the
// least important is left out, but for the title's first line.
int FrameOverlay::add_banner(double t, bool title, bool thickness, bool legend, int width,
                             DrawList& list) const {
  constexpr int most_rows = 40;
  constexpr float most = 0.7f;
  Parts wanted;
  if (title && !style_.title.empty()) wanted = {Part::title, Part::second_line};
  if (thickness) wanted.insert(Part::thickness);
  if (legend) wanted.insert(Part::legend);
  FrameOverlay wide = *this;
  wide.on_banner_ = true;
  wide.width_ = static_cast<float>(width);
  const std::size_t areas = list.areas.size(), lines = list.lines.size(), labels = list.labels.size();
  const auto cleared = [&] {
    list.areas.resize(areas), list.lines.resize(lines), list.labels.resize(labels);
  };
  const auto fit = [&] {
    Parts heading = wanted;
    heading.erase(Part::legend);
    cleared();
    wide.height_ = 1e6f;
    float bottom = 0.8f * edge_ + small_;
    for (const Piece& piece : wide.write_all(t, {}, heading, list)) bottom = std::max(bottom, piece.box.y1);
    for (int row = 0; row < most_rows; ++row) {
      cleared();
      wide.height_ =
          fine_ * std::ceil((bottom + edge_) / fine_ + 1.3f * static_cast<float>(row) * small_ / fine_);
      if (!wide.in_the_way(wide.write_all(t, {}, wanted, list))) break;
    }
  };
  for (fit(); wide.height_ > most * height_ && wanted.size() > 1; fit())
    wanted.erase(std::prev(wanted.end()));
  cleared();
  wide.write(t, {}, wanted, list);
  return list.labels.size() > labels ? static_cast<int>(wide.height_) : 0;
}

}  // namespace unfurl
