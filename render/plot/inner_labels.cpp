// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "render/plot/obstacles_of.hpp"
#include "render/plot/panel_layout.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

// Best of the candidate boxes: hides least, the first of equals.
Spot best_of(const Obstacles& obstacles, const std::vector<Rect>& boxes) {
  Spot best{boxes.front(), 1e300};
  for (const Rect& box : boxes)
    if (const double hidden = obstacles.hidden(box.grown(1.0)); hidden < best.hidden - 1e-6)
      best = {box, hidden};
  return best;
}

constexpr double away = 2.5;  // of a label from its line [points]

// Above and below a horizontal line from right to left; right and left of a vertical one from top to bottom.
std::vector<Rect> candidates(const Rect& frame, const ReferenceLine& line, double at, double width,
                             double height) {
  constexpr int places = 41;
  std::vector<Rect> boxes;
  for (int i = 0; i < places; ++i) {
    const double u = static_cast<double>(i) / (places - 1);
    if (line.horizontal) {
      const double x = frame.x1 - 3 - width - u * (frame.width() - width - 6);
      for (const double gap : {away, away + 0.5 * height}) {
        boxes.push_back({x, at - gap - height, x + width, at - gap});
        boxes.push_back({x, at + gap, x + width, at + gap + height});
      }
    } else {
      const double y = frame.y0 + 3 + u * (frame.height() - height - 6);
      boxes.push_back({at + away + 1, y, at + away + 1 + width, y + height});
      boxes.push_back({at - away - 1 - width, y, at - away - 1, y + height});
    }
  }
  std::vector<Rect> inside;
  std::copy_if(boxes.begin(), boxes.end(), std::back_inserter(inside),
               [&](const Rect& b) { return frame.grown(0.5).contains(b); });
  return inside;
}

// Where names of vertical lines may not stand [points]: at other such lines where there are many with a name
// of their own, of which none could be told whose it is.
std::vector<double> crowd(const Panel& panel, const PanelLayout& layout) {
  constexpr std::ptrdiff_t few = 5;
  std::vector<double> at;
  for (const ReferenceLine& line : panel.lines)
    if (!line.horizontal) at.push_back(layout.x.scale(line.value));
  const auto named = std::count_if(panel.lines.begin(), panel.lines.end(), [](const ReferenceLine& line) {
    return !line.horizontal && !line.label.empty();
  });
  return named > few ? at : std::vector<double>();
}

// So many lines, as even as the words allow, and no word cut; none where they do not.
std::vector<std::string> in_lines(const std::string& text, std::size_t count) {
  const double width = text_width(text, small_size), least = width / static_cast<double>(count);
  for (double room = least; room < width; room += 0.1 * least) {
    const std::vector<std::string> lines = wrap_text(text, small_size, room);
    std::string all;
    for (const std::string& line : lines) all += (all.empty() ? "" : " ") + line;
    if (all == text && lines.size() <= count)
      return lines.size() == count ? lines : std::vector<std::string>();
  }
  return {};
}

// In one line; the name of a vertical one in two or three where that hides less.
void add_line_label(const ReferenceLine& line, const std::vector<double>& others, Obstacles& obstacles,
                    PanelLayout& out) {
  if (line.label.empty()) return;
  const Rect& frame = out.frame;
  const double at = (line.horizontal ? out.y : out.x).scale(line.value);
  const std::string text = shorten_text(line.label, small_size, frame.width() - 8);
  const auto placed = [&](const std::vector<std::string>& lines) {
    double width = 0;
    for (const std::string& words : lines) width = std::max(width, text_width(words, small_size));
    const double below = line_height * static_cast<double>(lines.size() - 1);
    std::vector<Rect> boxes = candidates(frame, line, at, width, (ascent + descent + below) * small_size);
    if (!line.horizontal)
      std::erase_if(boxes, [&](const Rect& b) {  // with what lies between the name and its line
        const double x0 = std::min(b.x0 - 1, at), x1 = std::max(b.x1 + 1, at);
        return std::any_of(others.begin(), others.end(),
                           [&](double x) { return std::abs(x - at) > 0.5 && x > x0 && x < x1; });
      });
    return boxes.empty() ? Spot{{}, touches_text} : best_of(obstacles, boxes);
  };
  std::vector<std::string> lines{text};
  Spot spot = placed(lines);
  for (const std::size_t count : {std::size_t{2}, std::size_t{3}})
    if (!line.horizontal && spot.hidden > 0)
      if (const auto broken = in_lines(text, count); !broken.empty())
        if (const Spot other = placed(broken); other.hidden < spot.hidden) spot = other, lines = broken;
  if (spot.hidden >= touches_text) return;
  obstacles.add_box(spot.box);
  const bool right = lines.size() > 1 && spot.box.x1 < at;  // beside its line
  for (std::size_t k = 0; k < lines.size(); ++k)
    out.labels.push_back({{right ? spot.box.x1 : spot.box.x0,
                           spot.box.y0 + (ascent + line_height * static_cast<double>(k)) * small_size},
                          lines[k],
                          {small_size, readable(palette(line.color)), right ? Anchor::end : Anchor::start},
                          spot.hidden > 0});
}

// On a map the lines of a level are broken for its value, once, away from the edges and from other values.
void add_contour_labels(const Panel& panel, PanelLayout& out) {
  if (panel.cells.empty()) return;
  constexpr double enough = 40, least = 2;  // between values, and to the edges [points]
  std::vector<Rect> taken;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    if (panel.curves[i].label.empty()) continue;
    const double wide = 0.5 * text_width(panel.curves[i].label, small_size), tall = 0.5 * small_size;
    const auto box = [&](const Point& p) { return Rect{p.x - wide, p.y - tall, p.x + wide, p.y + tall}; };
    Point best{};
    double most = least;
    for (const Polyline& piece : out.curves[i])
      for (const Point& p : piece) {
        const Rect here = box(p);
        double free = std::min({enough, here.x0 - out.frame.x0, out.frame.x1 - here.x1,
                                here.y0 - out.frame.y0, out.frame.y1 - here.y1});
        for (const Rect& other : taken)
          free = std::min(free, std::max({here.x0 - other.x1, other.x0 - here.x1, here.y0 - other.y1,
                                          other.y0 - here.y1}));
        if (free > most) most = free, best = p;
      }
    if (most <= least) continue;
    taken.push_back(box(best));
    out.labels.push_back({{best.x, best.y + cap_height * small_size / 2},
                          panel.curves[i].label,
                          {small_size, ink, Anchor::middle},
                          true});
  }
}

void say_no_data(const Panel& panel, PanelLayout& out) {
  const bool drawn =
      std::any_of(out.curves.begin(), out.curves.end(), [](const auto& pieces) { return !pieces.empty(); }) ||
      std::any_of(out.bands.begin(), out.bands.end(), [](const BandTrace& b) { return !b.lower.empty(); });
  if (drawn || panel.bare || !panel.cells.empty() || !panel.segments.empty() || !panel.dots.empty()) return;
  const Point middle{(out.frame.x0 + out.frame.x1) / 2,
                     (out.frame.y0 + out.frame.y1) / 2 + cap_height * small_size / 2};
  out.labels.push_back({middle, "no data", {small_size, caption_color, Anchor::middle}, true});
}

// Below the frame, from its left edge.
void add_scale_bar(const Panel& panel, PanelLayout& out) {
  if (!(panel.scale_bar > 0)) return;
  const double length = panel.scale_bar / (out.x.scale.hi - out.x.scale.lo) * out.frame.width();
  const double text = text_width(panel.scale_bar_label, small_size);
  const double middle = out.frame.x0 + std::max(length, text) / 2, y = out.frame.y1 + scale_bar_height - 2;
  out.scale_bar = Rect{middle - length / 2, y, middle + length / 2, y};
  out.labels.push_back({{middle, y - 3.5}, panel.scale_bar_label, {small_size, ink, Anchor::middle}});
}

}  // namespace

Obstacles obstacles_of(const Panel& panel, const PanelLayout& layout) {
  Obstacles out;
  for (const auto& pieces : layout.curves)
    for (const Polyline& piece : pieces) out.add_line(piece);
  for (const BandTrace& band : layout.bands) {
    for (std::size_t i = 0; i < band.lower.size(); ++i) {
      for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        Polyline line = band.lower[i];
        for (std::size_t k = 0; k < line.size(); ++k) line[k].y += u * (band.upper[i][k].y - line[k].y);
        out.add_line(std::move(line));
      }
    }
  }
  for (const ReferenceLine& line : panel.lines) {
    const double at = (line.horizontal ? layout.y : layout.x).scale(line.value);
    const Rect& f = layout.frame;
    out.add_line(line.horizontal ? Polyline{{f.x0, at}, {f.x1, at}} : Polyline{{at, f.y0}, {at, f.y1}});
  }
  for (const Segment& s : panel.segments)
    out.add_line(
        {{layout.x.scale(s.x0), layout.y.scale(s.y0)}, {layout.x.scale(s.x1), layout.y.scale(s.y1)}});
  if (layout.legend && layout.legend->inside) out.add_box(layout.legend->box.grown(1));
  return out;
}

void add_inner_labels(const Panel& panel, PanelLayout& out) {
  Obstacles obstacles = obstacles_of(panel, out);
  const std::vector<double> others = crowd(panel, out);
  for (const ReferenceLine& line : panel.lines) add_line_label(line, others, obstacles, out);
  add_contour_labels(panel, out);
  add_scale_bar(panel, out);
  say_no_data(panel, out);
}

}  // namespace unfurl::plot
