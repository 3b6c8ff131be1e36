// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/plot/canvas.hpp"
#include "render/plot/pdf_document.hpp"
#include "render/plot/true_type.hpp"
#include "render/plot/typeface.hpp"

namespace unfurl::plot {

// Writes one page of PDF: lines and areas as paths, text as text in an embedded font of the glyphs it uses,
// which can be selected and searched.
class PdfCanvas final : public Canvas {
 public:
  struct Font {
    const Typeface& face;
    const TrueType& file;
  };
  // Size in points. A character is written in the first font that has it; they must outlive the canvas.
  PdfCanvas(double width, double height, std::vector<Font> fonts);

  void polyline(std::span<const Point> points, const Pen& pen) override;
  void band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) override;
  void convex(std::span<const Point> corners, FigureColor fill) override;
  void circle(Point center, double radius, FigureColor fill) override;
  void text(Point at, std::string_view text, const TextStyle& style) override;
  void begin_clip(const Rect& region) override;
  void end_clip() override;

  // The whole document. Call once, at the end.
  std::string finish(std::string_view title, std::string_view description);

 private:
  void point(Point p, const char* what);
  void path(std::span<const Point> points);
  void color(FigureColor c, bool stroke);
  void opacity(double alpha);
  // A font of the page with the glyphs that are used so far and what they mean.
  struct Used {
    Font font;
    std::map<int, char32_t> glyphs = {};
  };
  std::size_t font_of(char32_t c) const;
  static int add_font(PdfDocument& document, const Used& used);

  double width_, height_;
  std::vector<Used> fonts_;
  std::string out_;                     // the page's contents
  std::vector<double> opacities_{1.0};  // states /G0, /G1, ...
  double opacity_ = 1;                  // the current one
};

}  // namespace unfurl::plot
