#include "tests/render/plot/recording_canvas.hpp"

#include <cmath>

#include "render/plot/layout.hpp"
#include "render/plot/painter.hpp"
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

std::vector<std::string> faults(const Figure& figure) {
  const FigureLayout layout = lay_out(figure);
  RecordingCanvas canvas;
  paint(figure, layout, canvas);
  std::vector<std::string> out;
  const Rect page{0, 0, layout.width, layout.height};
  const auto add = [&](const std::string& what) { out.push_back(figure.name + ": " + what); };
  for (std::size_t i = 0; i < canvas.texts.size(); ++i) {
    const auto& t = canvas.texts[i];
    if (!page.contains(t.box)) add("outside the page: " + t.text);
    if (t.text.empty()) add("empty text");
    if (t.style.size < 6 || t.style.size > 12) add("text size of " + t.text);
    if (contrast_on_white(t.style.color) < 4.5) add("pale text: " + t.text);
    for (std::size_t k = 0; k < i; ++k)
      if (t.box.grown(-0.2).overlaps(canvas.texts[k].box))
        add("\"" + t.text + "\" over \"" + canvas.texts[k].text + "\"");
  }
  if (!canvas.finite) add("coordinates that are not finite");
  if (canvas.open_clips != 0) add("a clip region left open");
  for (const Point& p : canvas.unclipped)
    if (!page.grown(0.01).contains({p.x, p.y, p.x, p.y})) add("a stroke off the page");
  return out;
}

}  // namespace unfurl::plot
