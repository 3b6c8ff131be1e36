// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/pdf_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "core/text/utf8.hpp"
#include "render/plot/lacking_letters.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

// Six letters that tell this subset of the font from others (ISO 32000-1, 9.6.4).
std::string subset_tag(const std::map<int, char32_t>& used) {
  std::uint64_t hash = 1469598103934665603u;  // FNV-1a
  for (const auto& [glyph, c] : used) hash = (hash ^ static_cast<std::uint64_t>(glyph)) * 1099511628211u;
  std::string tag;
  for (int i = 0; i < 6; ++i, hash /= 26) tag += static_cast<char>('A' + hash % 26);
  return tag;
}

// Which characters the glyphs stand for, in chunks of a hundred as the format asks.
std::string to_unicode(const std::map<int, char32_t>& used) {
  std::string out =
      "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n"
      "/CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) /Supplement 0 >> def\n"
      "/CMapName /Adobe-Identity-UCS def\n/CMapType 2 def\n"
      "1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n";
  std::size_t left = used.size(), open = 0;
  for (const auto& [glyph, c] : used) {
    if (open == 0) out += std::to_string(open = std::min<std::size_t>(left, 100)) + " beginbfchar\n";
    out += "<" + hex4(static_cast<unsigned>(glyph)) + "> <" + hex4(static_cast<unsigned>(c)) + ">\n";
    --left;
    if (--open == 0) out += "endbfchar\n";
  }
  return out + "endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n";
}

std::string thousandths(double v) {
  return std::to_string(std::lround(1000 * v));
}
std::string reference(int object) {
  return std::to_string(object) + " 0 R";
}

}  // namespace

PdfCanvas::PdfCanvas(double width, double height, std::vector<Font> fonts)
    : width_(width), height_(height), out_("1 J 1 j\n") {  // round ends and joints
  for (const Font& font : fonts) fonts_.push_back({font});
}

std::size_t PdfCanvas::font_of(char32_t c) const {
  for (std::size_t k = 0; k < fonts_.size(); ++k)
    if (fonts_[k].font.face.advance(c) > 0 && fonts_[k].font.file.glyph(c) != 0) return k;
  for (std::size_t k = 0; k < fonts_.size(); ++k)
    if (fonts_[k].font.file.glyph(c) != 0) return k;
  return 0;
}

void PdfCanvas::point(Point p, const char* what) {
  out_ += pdf_number(p.x) + ' ' + pdf_number(height_ - p.y) + what;
}

void PdfCanvas::path(std::span<const Point> points) {
  for (std::size_t i = 0; i < points.size(); ++i) point(points[i], i == 0 ? " m\n" : " l\n");
}

void PdfCanvas::opacity(double alpha) {
  if (alpha == opacity_) return;
  opacity_ = alpha;
  auto at = std::find(opacities_.begin(), opacities_.end(), alpha);
  if (at == opacities_.end()) at = opacities_.insert(at, alpha);
  out_ += "/G" + std::to_string(at - opacities_.begin()) + " gs\n";
}

void PdfCanvas::color(FigureColor c, bool stroke) {
  opacity(c.a);
  for (const float v : {c.r, c.g, c.b}) out_ += pdf_number(std::clamp(v, 0.0f, 1.0f)) + ' ';
  out_ += stroke ? "RG\n" : "rg\n";
}

void PdfCanvas::polyline(std::span<const Point> points, const Pen& pen) {
  if (points.size() < 2) return;
  color(pen.color, true);
  const auto pattern = dash_pattern(pen.dash);
  out_ += pdf_number(pen.width) + " w\n";
  if (!pattern.empty()) {
    out_ += "0 J [";
    for (const double d : pattern) out_ += pdf_number(d * pen.width) + ' ';
    out_ += "] 0 d\n";
  }
  path(points);
  out_ += pattern.empty() ? "S\n" : "S\n[] 0 d 1 J\n";
}

void PdfCanvas::band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) {
  const std::size_t n = std::min(lower.size(), upper.size());
  std::vector<Point> outline(lower.begin(), lower.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t i = n; i-- > 0;) outline.push_back(upper[i]);
  convex(outline, fill);
}

void PdfCanvas::convex(std::span<const Point> corners, FigureColor fill) {
  if (corners.size() < 3) return;
  color(fill, false);
  path(corners);
  out_ += "h f\n";
}

// Four cubic curves, to 0.03 % of the radius.
void PdfCanvas::circle(Point c, double r, FigureColor fill) {
  color(fill, false);
  const double k = 0.5522847498 * r;
  point({c.x + r, c.y}, " m\n");
  const auto quarter = [&](Point a, Point b, Point end) { point(a, " "), point(b, " "), point(end, " c\n"); };
  quarter({c.x + r, c.y + k}, {c.x + k, c.y + r}, {c.x, c.y + r});
  quarter({c.x - k, c.y + r}, {c.x - r, c.y + k}, {c.x - r, c.y});
  quarter({c.x - r, c.y - k}, {c.x - k, c.y - r}, {c.x, c.y - r});
  quarter({c.x + k, c.y - r}, {c.x + r, c.y - k}, {c.x + r, c.y});
  out_ += "f\n";
}

void PdfCanvas::text(Point at, std::string_view text, const TextStyle& style) {
  std::string shown;
  double width = 0;
  for (std::size_t i = 0, last = fonts_.size(); i < text.size();) {
    const std::size_t first = i;
    const char32_t c = next_code_point(text, i);
    const std::size_t k = font_of(c);
    const TrueType& file = fonts_[k].font.file;
    const int glyph = file.glyph(c);
    if (glyph == 0) note_lacking(text.substr(first, i - first));
    fonts_[k].glyphs.emplace(glyph, glyph == 0 ? U'\uFFFD' : c);
    if (k != last) {
      shown += shown.empty() ? "" : "> Tj ";
      shown += "/F" + std::to_string(k + 1) + ' ' + pdf_number(style.size) + " Tf <";
      last = k;
    }
    shown += hex4(static_cast<unsigned>(glyph));
    width += file.advance(glyph) * style.size;
  }
  if (shown.empty()) return;
  const double before = style.anchor == Anchor::start    ? 0
                        : style.anchor == Anchor::middle ? width / 2
                                                         : width;
  color(style.color, false);
  out_ += std::string("BT ") + (style.upward ? "0 1 -1 0 " : "1 0 0 1 ");
  point(style.upward ? Point{at.x, at.y + before} : Point{at.x - before, at.y}, " Tm ");
  out_ += shown + "> Tj ET\n";
}

void PdfCanvas::begin_clip(const Rect& r) {
  out_ += "q\n";
  point({r.x0, r.y1}, " ");
  out_ += pdf_number(r.width()) + ' ' + pdf_number(r.height()) + " re W n\n";
}

void PdfCanvas::end_clip() {
  out_ += "Q\n";
  opacity_ = -1;  // that of before the clip, whatever it was: to be said again
}

int PdfCanvas::add_font(PdfDocument& document, const Used& used) {
  const TrueType& font = used.font.file;
  std::set<int> glyphs;
  std::string widths;
  for (const auto& [glyph, c] : used.glyphs) {
    glyphs.insert(glyph);
    widths += std::to_string(glyph) + " [" + thousandths(font.advance(glyph)) + "] ";
  }
  const std::string name = "/" + subset_tag(used.glyphs) + "+" + std::string(used.font.face.pdf_name),
                    file = font.subset(glyphs);
  const int program = document.add_stream(file, "/Length1 " + std::to_string(file.size()));
  const TrueType::Box box = font.bounds();
  const int descriptor = document.add(
      "<< /Type /FontDescriptor /FontName " + name + " /Flags 4 /FontBBox [" + thousandths(box.x0) + ' ' +
      thousandths(box.y0) + ' ' + thousandths(box.x1) + ' ' + thousandths(box.y1) +
      "] /ItalicAngle 0 /Ascent " + thousandths(font.ascent()) + " /Descent " + thousandths(font.descent()) +
      " /CapHeight " + thousandths(cap_height) + " /StemV 80 /FontFile2 " + reference(program) + " >>");
  const int descendant = document.add(
      "<< /Type /Font /Subtype /CIDFontType2 /BaseFont " + name +
      " /CIDSystemInfo << /Registry (Adobe) /Ordering (Identity) /Supplement 0 >> /FontDescriptor " +
      reference(descriptor) + " /CIDToGIDMap /Identity /DW 600 /W [" + widths + "] >>");
  const int map = document.add_stream(to_unicode(used.glyphs));
  return document.add("<< /Type /Font /Subtype /Type0 /BaseFont " + name +
                      " /Encoding /Identity-H /DescendantFonts [" + reference(descendant) + "] /ToUnicode " +
                      reference(map) + " >>");
}

std::string PdfCanvas::finish(std::string_view title, std::string_view description) {
  PdfDocument document;
  const int catalog = document.reserve(), pages = document.reserve();
  const int contents = document.add_stream(out_);
  std::string resources;
  std::string fonts;
  for (std::size_t k = 0; k < fonts_.size(); ++k)
    if (!fonts_[k].glyphs.empty())
      fonts += "/F" + std::to_string(k + 1) + ' ' + reference(add_font(document, fonts_[k])) + ' ';
  if (!fonts.empty()) resources += "/Font << " + fonts + ">> ";
  resources += "/ExtGState <<";
  for (std::size_t i = 0; i < opacities_.size(); ++i)
    resources += " /G" + std::to_string(i) + " << /CA " + pdf_number(opacities_[i]) + " /ca " +
                 pdf_number(opacities_[i]) + " >>";
  resources += " >>";
  const int page = document.add("<< /Type /Page /Parent " + reference(pages) + " /MediaBox [0 0 " +
                                pdf_number(width_) + ' ' + pdf_number(height_) + "] /Contents " +
                                reference(contents) + " /Resources << " + resources + " >> >>");
  document.put(pages, "<< /Type /Pages /Kids [" + reference(page) + "] /Count 1 >>");
  document.put(catalog, "<< /Type /Catalog /Pages " + reference(pages) +
                            " /Lang (en) /ViewerPreferences << /DisplayDocTitle true >> >>");
  const int info = document.add("<< /Title " + pdf_string(title) + " /Subject " + pdf_string(description) +
                                " /Creator (Unfurl) >>");
  return document.finish(catalog, info);
}

}  // namespace unfurl::plot
