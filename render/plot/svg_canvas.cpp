// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/svg_canvas.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/text/utf8.hpp"
#include "core/text/xml_text.hpp"
#include "render/plot/style.hpp"
#include "render/plot/typeface.hpp"

namespace unfurl::plot {
namespace {

// What the typeface has not is said to be of the one that lends it: digits of one exponent look alike.
std::string marked_text(std::string_view text) {
  const Typeface &own = typeface(), &lender = typefaces().front();
  std::string out;
  bool lent = false;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t begin = i;
    const char32_t c = next_code_point(text, i);
    const bool now = own.advance(c) == 0 && lender.advance(c) > 0;
    if (now && !lent) out += "<tspan font-family=\"" + std::string(lender.families) + "\">";
    if (lent && !now) out += "</tspan>";
    lent = now;
    out += xml_text(text.substr(begin, i - begin));
  }
  return lent ? out + "</tspan>" : out;
}

}  // namespace

SvgCanvas::SvgCanvas(double width, double height, std::string_view title, std::string_view description) {
  out_ =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" "
      "width=\"";
  number(width / points_per_mm);
  out_ += "mm\" height=\"";
  number(height / points_per_mm);
  out_ += "mm\" viewBox=\"0 0 ";
  number(width);
  out_ += ' ';
  number(height);
  out_ += "\" font-family=\"" + std::string(typeface().families) +
          "\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
  out_ += "<title>" + xml_text(title) + "</title>\n<desc>" + xml_text(description) + "</desc>\n";
}

std::string SvgCanvas::finish() {
  out_ += "</svg>\n";
  return std::move(out_);
}

void SvgCanvas::number(double value) {
  char text[32];
  const double rounded = std::round(value * 100) / 100 + 0.0;  // a hundredth of a point; no "-0"
  const auto end = std::to_chars(text, text + sizeof text, rounded).ptr;
  out_.append(text, end);
}

void SvgCanvas::point(Point p) {
  number(p.x);
  out_ += ',';
  number(p.y);
}

void SvgCanvas::points(std::span<const Point> points) {
  out_ += " points=\"";
  for (const Point& p : points) {
    point(p);
    out_ += ' ';
  }
  if (!points.empty()) out_.pop_back();
  out_ += '"';
}

void SvgCanvas::paint(const char* what, FigureColor c) {
  const auto byte = [](float v) { return static_cast<int>(std::lround(255 * std::clamp(v, 0.0f, 1.0f))); };
  char text[64];
  std::snprintf(text, sizeof text, " %s=\"#%02X%02X%02X\"", what, byte(c.r), byte(c.g), byte(c.b));
  out_ += text;
  if (c.a >= 1) return;
  out_ += ' ';
  out_ += what;
  out_ += "-opacity=\"";
  number(c.a);
  out_ += '"';
}

void SvgCanvas::polyline(std::span<const Point> line, const Pen& pen) {
  if (line.size() < 2) return;
  out_ += "<polyline fill=\"none\" stroke-width=\"";
  number(pen.width);
  out_ += '"';
  paint("stroke", pen.color);
  if (const auto pattern = dash_pattern(pen.dash); !pattern.empty()) {
    out_ += " stroke-linecap=\"butt\" stroke-dasharray=\"";
    for (const double d : pattern) {
      number(d * pen.width);
      out_ += ' ';
    }
    out_.back() = '"';
  }
  points(line);
  out_ += "/>\n";
}

void SvgCanvas::band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) {
  std::vector<Point> outline(lower.begin(), lower.end());
  outline.insert(outline.end(), upper.rbegin(), upper.rend());
  convex(outline, fill);
}

void SvgCanvas::convex(std::span<const Point> corners, FigureColor fill) {
  if (corners.size() < 3) return;
  out_ += "<polygon";
  paint("fill", fill);
  points(corners);
  out_ += "/>\n";
}

void SvgCanvas::circle(Point center, double radius, FigureColor fill) {
  out_ += "<circle cx=\"";
  number(center.x);
  out_ += "\" cy=\"";
  number(center.y);
  out_ += "\" r=\"";
  number(radius);
  out_ += '"';
  paint("fill", fill);
  out_ += "/>\n";
}

void SvgCanvas::text(Point at, std::string_view text, const TextStyle& style) {
  out_ += "<text x=\"";
  number(at.x);
  out_ += "\" y=\"";
  number(at.y);
  out_ += "\" font-size=\"";
  number(style.size);
  out_ += '"';
  paint("fill", style.color);
  if (style.anchor == Anchor::middle) out_ += " text-anchor=\"middle\"";
  if (style.anchor == Anchor::end) out_ += " text-anchor=\"end\"";
  if (style.upward) {
    out_ += " transform=\"rotate(-90 ";
    number(at.x);
    out_ += ' ';
    number(at.y);
    out_ += ")\"";
  }
  out_ += ">" + marked_text(text) + "</text>\n";
}

void SvgCanvas::begin_clip(const Rect& r) {
  const std::string id = "clip" + std::to_string(++clips_);
  out_ += "<clipPath id=\"" + id + "\"><rect x=\"";
  number(r.x0);
  out_ += "\" y=\"";
  number(r.y0);
  out_ += "\" width=\"";
  number(r.width());
  out_ += "\" height=\"";
  number(r.height());
  out_ += "\"/></clipPath>\n<g clip-path=\"url(#" + id + ")\">\n";
}

void SvgCanvas::end_clip() {
  out_ += "</g>\n";
}

}  // namespace unfurl::plot
