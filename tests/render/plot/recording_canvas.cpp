// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/plot/recording_canvas.hpp"

#include <cmath>

#include "render/plot/layout.hpp"
#include "render/plot/painter.hpp"
#include "render/plot/scaled_canvas.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {

void RecordingCanvas::see(Point p) {
  finite = finite && std::isfinite(p.x) && std::isfinite(p.y);
  ++points;
  if (open_clips == 0) unclipped.push_back(p);
}

void RecordingCanvas::polyline(std::span<const Point> line, const Pen& pen) {
  finite = finite && pen.width > 0;
  widths.push_back(pen.width);
  for (const Point& p : line) see(p);
}
void RecordingCanvas::band(std::span<const Point> lower, std::span<const Point> upper, FigureColor) {
  for (const Point& p : lower) see(p);
  for (const Point& p : upper) see(p);
}
void RecordingCanvas::convex(std::span<const Point> corners, FigureColor) {
  for (const Point& p : corners) see(p);
}
void RecordingCanvas::circle(Point center, double, FigureColor) {
  see(center);
}
void RecordingCanvas::text(Point at, std::string_view text, const TextStyle& style) {
  texts.push_back({std::string(text), style, text_box(at, text, style)});
}
void RecordingCanvas::begin_clip(const Rect&) {
  ++open_clips;
}
void RecordingCanvas::end_clip() {
  --open_clips;
}

namespace {

struct Sizes {
  double least, most;
};
// What text of a style may measure [points]: 5 to 7 in print as journals ask, 12 and more on a slide.
Sizes text_sizes_of(const FigureStyle& style) {
  if (style.name == "slide") return {12, 20};
  return style.name == "screen" ? Sizes{6, 12} : Sizes{5, 7};
}

}  // namespace

std::vector<std::string> faults(const Figure& figure, const FigureStyle& style) {
  const FigureLayout layout = lay_out(figure, layout_options(figure, style));
  RecordingCanvas canvas;
  ScaledCanvas scaled(canvas, layout.scale);
  paint(figure, layout, scaled);
  std::vector<std::string> out;
  const Rect page{0, 0, layout.scale * layout.width, layout.scale * layout.height};
  const Sizes sizes = text_sizes_of(style);
  const auto add = [&](const std::string& what) { out.push_back(figure.name + ": " + what); };
  const double wanted = style.width_mm > 0 ? style.width_mm : figure.width_mm;
  if (std::abs(page.width() / points_per_mm - wanted) > 0.01)
    add("the page is not as wide as the style says");
  for (std::size_t i = 0; i < canvas.texts.size(); ++i) {
    const auto& t = canvas.texts[i];
    if (!page.contains(t.box)) add("outside the page: " + t.text);
    if (t.text.empty()) add("empty text");
    if (t.style.size < sizes.least || t.style.size > sizes.most) add("text size of " + t.text);
    if (contrast_on_white(t.style.color) < 4.5) add("pale text: " + t.text);
    for (std::size_t k = 0; k < i; ++k)
      if (t.box.grown(-0.2).overlaps(canvas.texts[k].box))
        add("\"" + t.text + "\" over \"" + canvas.texts[k].text + "\"");
  }
  for (const double width : canvas.widths)  // journals ask for 0.25 points and more
    if (width < 0.25) add("a stroke too thin to print");
  if (!canvas.finite) add("coordinates that are not finite");
  if (canvas.open_clips != 0) add("a clip region left open");
  for (const Point& p : canvas.unclipped)
    if (!page.grown(0.01).contains({p.x, p.y, p.x, p.y})) add("a stroke off the page");
  return out;
}

std::vector<std::string> twins(const Figure& figure) {
  std::vector<std::string> out;
  for (const Panel& p : figure.panels)
    for (std::size_t i = 0; i < p.curves.size() && p.cells.empty(); ++i)  // contours carry their numbers
      for (std::size_t k = 0; k < i; ++k) {
        const Curve &a = p.curves[i], &b = p.curves[k];
        if (a.label.empty() || b.label.empty() || a.x.empty() || b.x.empty()) continue;
        if (a.dash == b.dash && a.marker == b.marker)
          out.push_back(figure.name + ": \"" + a.label + "\" is drawn as \"" + b.label + "\"");
      }
  return out;
}

}  // namespace unfurl::plot
