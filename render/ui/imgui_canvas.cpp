// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/imgui_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/text/utf8.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

constexpr std::size_t chunk = 8000;  // ImGui's 16-bit indices wrap in longer polylines
constexpr float sharp = 0.9f;        // cosine of the turn above which a joint needs no cap

ImU32 packed(FigureColor c) {
  return ImGui::ColorConvertFloat4ToU32(ImVec4(c.r, c.g, c.b, c.a));
}

bool axis_aligned(std::span<const ImVec2> p) {
  for (std::size_t i = 1; i < p.size(); ++i)
    if (p[i].x != p[i - 1].x && p[i].y != p[i - 1].y) return false;
  return p.size() <= 5;
}

// Cosine of the angle by which a-b-c turns; 1 straight on.
float turn(ImVec2 a, ImVec2 b, ImVec2 c) {
  const float ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
  const float size = std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
  return size > 0 ? (ux * vx + uy * vy) / size : 1.0f;
}

// Without points that fall on the one before: they have no direction.
std::vector<ImVec2> distinct(std::vector<ImVec2> points) {
  const auto same = [](ImVec2 a, ImVec2 b) {
    return std::abs(a.x - b.x) < 0.01f && std::abs(a.y - b.y) < 0.01f;
  };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  return points;
}

}  // namespace

// From the last corner every point in between leaves a wedge of directions that pass it within the tolerance
// t: half its angle is asin(t / d) at a distance d. A point in the common wedge may be the next corner; the
// last such becomes it. A line that comes back towards its corner would be cut short: it ends there.
std::vector<ImVec2> straightened(std::span<const ImVec2> points, float tolerance) {
  if (points.size() < 3 || tolerance <= 0) return {points.begin(), points.end()};
  const auto cross = [](ImVec2 a, ImVec2 b) { return a.x * b.y - a.y * b.x; };
  const auto turned = [](ImVec2 v, float cosine, float sine) {
    return ImVec2(v.x * cosine - v.y * sine, v.x * sine + v.y * cosine);
  };
  std::vector<ImVec2> corners{points.front()};
  ImVec2 low, high;  // sides of the wedge
  bool open = true;  // on all sides
  float farthest = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    ImVec2 d(points[i].x - corners.back().x, points[i].y - corners.back().y);
    float away = std::hypot(d.x, d.y);
    const bool inside = open || (cross(low, d) >= 0 && cross(d, high) >= 0);
    if (i > 1 && (!inside || away < farthest)) {
      corners.push_back(points[i - 1]);
      open = true;
      d = {points[i].x - points[i - 1].x, points[i].y - points[i - 1].y};
      away = std::hypot(d.x, d.y);
    }
    farthest = away;
    if (away <= tolerance) continue;
    const float sine = tolerance / away, cosine = std::sqrt(1 - sine * sine);
    const ImVec2 below = turned(d, cosine, -sine), above = turned(d, cosine, sine);
    if (open || cross(low, below) > 0) low = below;
    if (open || cross(above, high) > 0) high = above;
    open = false;
  }
  corners.push_back(points.back());
  return corners;
}

ImguiCanvas::ImguiCanvas(ImDrawList& list, Fonts fonts, double pixels_per_point, Point origin,
                         double tolerance)
    : list_(list),
      fonts_(std::move(fonts)),
      scale_(pixels_per_point),
      origin_(origin),
      tolerance_(static_cast<float>(tolerance)),
      flags_(list.Flags) {
  list_.Flags |= ImDrawListFlags_AntiAliasedLines | ImDrawListFlags_AntiAliasedFill;
  list_.Flags &= ~ImDrawListFlags_AntiAliasedLinesUseTex;  // knows whole widths only
}

ImguiCanvas::~ImguiCanvas() {
  list_.Flags = flags_;
}

float ImguiCanvas::font_pixels(double size, double pixels_per_point) {
  return static_cast<float>(size * line_height * pixels_per_point);
}

ImVec2 ImguiCanvas::pixel(Point p) const {
  return {static_cast<float>(origin_.x + p.x * scale_), static_cast<float>(origin_.y + p.y * scale_)};
}

void ImguiCanvas::polyline(std::span<const Point> points, const Pen& pen) {
  std::vector<ImVec2> line;
  line.reserve(points.size());
  for (const Point& p : points) line.push_back(pixel(p));
  line = straightened(distinct(std::move(line)), tolerance_);
  if (line.size() < 2) return;
  const auto width = static_cast<float>(pen.width * scale_);
  const auto pattern = dash_pattern(pen.dash);
  if (pattern.empty())
    stroke(line, width, packed(pen.color), true);
  else
    dashed(line, pattern, width, packed(pen.color));
}

// Runs without sharp corners, joined by round caps: ImGui's own joints break down at sharp angles.
void ImguiCanvas::stroke(std::span<const ImVec2> points, float width, ImU32 color, bool round_ends) {
  if (width < 1.0 * scale_ && axis_aligned(points)) {
    for (std::size_t i = 1; i < points.size(); ++i) straight(points[i - 1], points[i], width, color);
    return;
  }
  const auto cap = [&](ImVec2 at) {
    if (width > 1.5f) list_.AddCircleFilled(at, width / 2, color);
  };
  for (std::size_t begin = 0; begin + 1 < points.size();) {
    std::size_t end = begin + 1;
    while (end + 1 < points.size() && end - begin < chunk &&
           turn(points[end - 1], points[end], points[end + 1]) > sharp)
      ++end;
    list_.AddPolyline(&points[begin], static_cast<int>(end - begin + 1), color, 0, width);
    if (end + 1 < points.size()) cap(points[end]);
    begin = end;
  }
  if (round_ends) cap(points.front()), cap(points.back());
}

// A horizontal or vertical line fills whole pixels: thin lines stay crisp.
void ImguiCanvas::straight(ImVec2 a, ImVec2 b, float width, ImU32 color) {
  const float whole = std::max(1.0f, std::round(width)), half = whole / 2;
  const auto snap = [&](float v) { return std::round(v - half); };  // the first pixel of the line's width
  if (a.y == b.y) {
    const float y = snap(a.y);
    list_.AddRectFilled({std::round(std::min(a.x, b.x) - half), y},
                        {std::round(std::max(a.x, b.x) + half), y + whole}, color);
  } else {
    const float x = snap(a.x);
    list_.AddRectFilled({x, std::round(std::min(a.y, b.y) - half)},
                        {x + whole, std::round(std::max(a.y, b.y) + half)}, color);
  }
}

void ImguiCanvas::dashed(std::span<const ImVec2> points, std::span<const double> pattern, float width,
                         ImU32 color) {
  std::vector<ImVec2> piece{points[0]};
  std::size_t k = 0;  // of the pattern: even draws, odd leaves out
  float left = static_cast<float>(pattern[0]) * width;
  for (std::size_t i = 1; i < points.size(); ++i) {
    ImVec2 from = points[i - 1];
    float length = std::hypot(points[i].x - from.x, points[i].y - from.y);
    while (length > left) {
      const float u = left / length;
      from = {from.x + u * (points[i].x - from.x), from.y + u * (points[i].y - from.y)};
      length -= left;
      piece.push_back(from);
      if (k % 2 == 0) stroke(piece, width, color, false);
      piece.assign(1, from);
      k = (k + 1) % pattern.size();
      left = static_cast<float>(pattern[k]) * width;
    }
    left -= length;
    if (length > 0.01f) piece.push_back(points[i]);
  }
  if (k % 2 == 0 && piece.size() > 1) stroke(piece, width, color, false);
}

void ImguiCanvas::band(std::span<const Point> lower, std::span<const Point> upper, FigureColor fill) {
  const ImU32 color = packed(fill);
  const ImDrawListFlags flags = list_.Flags;
  list_.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // soft edges between the strips would show as lines
  for (std::size_t i = 1; i < std::min(lower.size(), upper.size()); ++i)
    list_.AddQuadFilled(pixel(lower[i - 1]), pixel(upper[i - 1]), pixel(upper[i]), pixel(lower[i]), color);
  list_.Flags = flags;
}

void ImguiCanvas::convex(std::span<const Point> corners, FigureColor fill) {
  std::vector<ImVec2> points;
  for (const Point& p : corners) points.push_back(pixel(p));
  const auto round = [](ImVec2 p) { return ImVec2(std::round(p.x), std::round(p.y)); };
  if (points.size() == 4 && axis_aligned(points))
    list_.AddRectFilled(round(points[0]), round(points[2]), packed(fill));
  else
    list_.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), packed(fill));
}

void ImguiCanvas::circle(Point center, double radius, FigureColor fill) {
  list_.AddCircleFilled(pixel(center), static_cast<float>(radius * scale_), packed(fill));
}

// Glyph by glyph: ImGui's AddText leaves out what lies outside the clip rectangle before it could be turned.
void ImguiCanvas::text(Point at, std::string_view text, const TextStyle& style) {
  ImFont* font = fonts_(font_pixels(style.size, scale_));
  std::vector<const ImFontGlyph*> glyphs;
  float width = 0;
  for (std::size_t i = 0; i < text.size();) {
    glyphs.push_back(
        font->FindGlyph(static_cast<ImWchar>(std::min<char32_t>(next_code_point(text, i), 0xFFFD))));
    width += glyphs.back()->AdvanceX;
  }
  const ImU32 color = packed(style.color);
  const ImVec2 start = pixel(at);
  float along = style.anchor == Anchor::start ? 0 : style.anchor == Anchor::middle ? -width / 2 : -width;
  const float base = std::round(font->Ascent);
  const bool up = style.upward;
  // The atlas is sharp where the baseline falls on whole pixels.
  const float across = std::round(up ? start.x : start.y);
  along = up ? along : std::round(start.x + along) - start.x;
  for (const ImFontGlyph* g : glyphs) {
    const float u0 = along + g->X0, u1 = along + g->X1, v0 = across + g->Y0 - base,
                v1 = across + g->Y1 - base;
    along += g->AdvanceX;
    if (!g->Visible) continue;
    list_.PrimReserve(6, 4);
    const auto corner = [&](float u, float v) {
      return up ? ImVec2(v, start.y - u) : ImVec2(start.x + u, v);
    };
    list_.PrimQuadUV(corner(u0, v0), corner(u1, v0), corner(u1, v1), corner(u0, v1), {g->U0, g->V0},
                     {g->U1, g->V0}, {g->U1, g->V1}, {g->U0, g->V1}, color);
  }
}

void ImguiCanvas::begin_clip(const Rect& r) {
  list_.PushClipRect(pixel({r.x0, r.y0}), pixel({r.x1, r.y1}), true);
}

void ImguiCanvas::end_clip() {
  list_.PopClipRect();
}

}  // namespace unfurl::plot
