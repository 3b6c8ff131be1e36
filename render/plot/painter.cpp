// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/plot/pose_painter.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

constexpr double marker_radius = 1.9;  // [points]

class PanelPainter {
 public:
  PanelPainter(const Panel& panel, const PanelLayout& layout, Canvas& canvas)
      : panel_(panel), layout_(layout), canvas_(canvas), frame_(layout.frame) {}

  void paint() {
    if (!panel_.bare && panel_.cells.empty()) grid();
    const bool marked = std::any_of(panel_.curves.begin(), panel_.curves.end(),
                                    [](const Curve& c) { return c.marker != Marker::none; });
    canvas_.begin_clip(frame_.grown(panel_.bare ? 4 : marked ? 3 : 1.2));
    cells();
    bands();
    pale_references();
    curves();
    references();
    paint_pose(panel_, layout_, canvas_);
    canvas_.end_clip();
    if (!panel_.bare) axes();
    scale_bar();
    for (const Label& label : layout_.labels) text(label);
    legend();
  }

 private:
  void grid() {
    const Pen pen{grid_color, grid_width};
    for (const double v : layout_.x.ticks.major) vertical(layout_.x.scale(v), pen);
    for (const double v : layout_.y.ticks.major) horizontal(layout_.y.scale(v), pen);
  }

  // Each a little over its right and lower neighbour, so that no seam of the ground shows between them.
  void cells() {
    constexpr double overlap = 0.3;
    for (const Cell& c : panel_.cells) {
      const double x0 = layout_.x.scale(c.x0), x1 = layout_.x.scale(c.x1);
      const double y0 = layout_.y.scale(c.y0), y1 = layout_.y.scale(c.y1);
      canvas_.rectangle(
          {std::min(x0, x1), std::min(y0, y1), std::max(x0, x1) + overlap, std::max(y0, y1) + overlap},
          c.fill);
    }
  }

  void bands() {
    for (std::size_t i = 0; i < layout_.bands.size(); ++i) {
      FigureColor fill = palette(panel_.bands[i].color);
      fill.a = band_opacity;
      const BandTrace& band = layout_.bands[i];
      for (std::size_t k = 0; k < band.lower.size(); ++k) canvas_.band(band.lower[k], band.upper[k], fill);
    }
  }

  void reference(const ReferenceLine& line, const Pen& pen) {
    if (line.horizontal)
      horizontal(layout_.y.scale(line.value), pen);
    else
      vertical(layout_.x.scale(line.value), pen);
  }

  void references() {
    for (const ReferenceLine& line : panel_.lines)
      if (!line.pale) reference(line, {palette(line.color), reference_width, Dash::dashed});
  }

  // Below the curves.
  void pale_references() {
    constexpr double least_apart = 3;  // [points]
    double last = -std::numeric_limits<double>::infinity();
    for (const ReferenceLine& line : panel_.lines) {
      const double at = line.horizontal ? layout_.y.scale(line.value) : layout_.x.scale(line.value);
      if (!line.pale || std::abs(at - last) < least_apart) continue;
      last = at;
      reference(line, {lighter(palette(line.color), 0.6f), grid_width, Dash::dashed});
    }
  }

  void curves() {
    for (std::size_t i = 0; i < layout_.curves.size(); ++i) {
      const Curve& c = panel_.curves[i];
      const FigureColor color = palette(c.color);
      for (const Polyline& piece : layout_.curves[i]) {
        if (c.width > 0) canvas_.polyline(piece, {color, c.width, c.dash});
        if (piece.size() == 1 && c.marker == Marker::none)
          canvas_.circle(piece[0], std::max(1.6, 0.8 * c.width), color);
        markers(c, piece);
      }
    }
  }

  // Markers closer than 4 points would run into each other.
  void markers(const Curve& c, const Polyline& piece) {
    if (c.marker == Marker::none) return;
    const Point* last = nullptr;
    for (const Point& p : piece) {
      if (last && std::hypot(p.x - last->x, p.y - last->y) < 4) continue;
      if (!panel_.cells.empty())  // of any colour
        canvas_.marker(c.marker, p, 1.6 * marker_radius * c.marker_size, white);
      canvas_.marker(c.marker, p, marker_radius * c.marker_size, palette(c.color));
      last = &p;
    }
  }

  void axes() {
    const Pen pen{axis_color, axis_width};
    const Rect& f = frame_;
    const std::array spine{Point{f.x0, f.y0}, Point{f.x0, f.y1}, Point{f.x1, f.y1}, Point{f.x1, f.y0}};
    canvas_.polyline(std::span(spine).first(layout_.y2.used ? 4 : 3), pen);
    const auto ticks = [&](const AxisLayout& axis, auto&& draw) {
      for (const double v : axis.ticks.minor) draw(axis.scale(v), minor_tick_length);
      for (const double v : axis.ticks.major) draw(axis.scale(v), tick_length);
    };
    ticks(layout_.x, [&](double x, double length) { canvas_.line({x, f.y1}, {x, f.y1 + length}, pen); });
    if (panel_.y.shown)
      ticks(layout_.y, [&](double y, double length) { canvas_.line({f.x0, y}, {f.x0 - length, y}, pen); });
    if (layout_.y2.used)
      ticks(layout_.y2, [&](double y, double length) { canvas_.line({f.x1, y}, {f.x1 + length, y}, pen); });
  }

  void scale_bar() {
    if (!layout_.scale_bar) return;
    const Rect& bar = *layout_.scale_bar;
    const Pen pen{ink, 0.9};
    canvas_.line({bar.x0, bar.y0}, {bar.x1, bar.y0}, pen);
    for (const double x : {bar.x0, bar.x1}) canvas_.line({x, bar.y0 - 1.5}, {x, bar.y0 + 1.5}, pen);
  }

  void legend() {
    if (!layout_.legend) return;
    if (layout_.legend->inside) canvas_.rectangle(layout_.legend->box, {1, 1, 1, 0.8f});
    for (const LegendEntry& e : layout_.legend->entries) {
      const Point from = e.sample, to{from.x + legend_sample, from.y};
      if (e.band) {
        FigureColor fill = palette(e.band->color);
        fill.a = band_opacity;
        canvas_.rectangle({from.x, from.y - 2.6, to.x, to.y + 2.6}, fill);
        for (const double y : {from.y - 2.6, from.y + 2.6})
          canvas_.line({from.x, y}, {to.x, y}, {palette(e.band->color), 0.8});
      } else if (e.curve) {
        const FigureColor color = palette(e.curve->color);
        if (e.curve->width > 0) canvas_.line(from, to, {color, e.curve->width, e.curve->dash});
        canvas_.marker(e.curve->marker, {(from.x + to.x) / 2, from.y}, marker_radius * e.curve->marker_size,
                       color);
      }
      text(e.label);
    }
  }

  void text(const Label& label) {
    if (label.backed)
      canvas_.rectangle(text_box(label.at, label.text, label.style).grown(1), {1, 1, 1, 0.8f});
    canvas_.text(label.at, label.text, label.style);
  }

  void horizontal(double y, const Pen& pen) {
    if (y > frame_.y0 - 1 && y < frame_.y1 + 1) canvas_.line({frame_.x0, y}, {frame_.x1, y}, pen);
  }
  void vertical(double x, const Pen& pen) {
    if (x > frame_.x0 - 1 && x < frame_.x1 + 1) canvas_.line({x, frame_.y0}, {x, frame_.y1}, pen);
  }

  const Panel& panel_;
  const PanelLayout& layout_;
  Canvas& canvas_;
  const Rect& frame_;
};

}  // namespace

void paint(const Figure& figure, const FigureLayout& layout, Canvas& canvas) {
  canvas.rectangle({0, 0, layout.width, layout.height}, white);
  for (std::size_t i = 0; i < layout.panels.size(); ++i)
    PanelPainter(figure.panels[i], layout.panels[i], canvas).paint();
  for (const Label& label : layout.labels) canvas.text(label.at, label.text, label.style);
}

}  // namespace unfurl::plot
