// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/sheet.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "render/gl/context.hpp"
#include "render/gl/framebuffer.hpp"
#include "render/gl/functions.hpp"
#include "render/scene/text_overlay.hpp"
#include "render/ui/font_file.hpp"
#include "render/ui/imgui_canvas.hpp"

using namespace unfurl;

namespace sheet_test {

namespace {

constexpr ImU32 black = IM_COL32(0, 0, 0, 255), red = IM_COL32(255, 0, 0, 255);

std::uint8_t channel(const Image& image, int x, int y, int c) {
  return image.rgba.at(4 * static_cast<std::size_t>(y * image.width + x) + static_cast<std::size_t>(c));
}

// The box of all pixels that are not white: left, top, right, bottom (inclusive); -1 where there is none.
std::array<int, 4> inked(const Image& image) {
  std::array<int, 4> box{-1, -1, -1, -1};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (channel(image, x, y, 0) == 255 && channel(image, x, y, 1) == 255) continue;
      if (box[1] < 0) box = {x, y, x, y};
      box = {std::min(box[0], x), box[1], std::max(box[2], x), y};
    }
  }
  return box;
}

struct Paper {
  std::unique_ptr<GlContext> context = make_offscreen_context();
  Framebuffer frame{200, 100, 0};
  Paper() { clear(); }
  void clear() const {
    gl::ClearColor(1, 1, 1, 1);
    gl::Clear(GL_COLOR_BUFFER_BIT);
  }
};

}  // namespace

TEST_CASE("a rectangle covers exactly its pixels") {
  const Paper paper;
  Sheet sheet;
  sheet.begin(200, 100).AddRectFilled({20, 30}, {50, 40}, red);
  sheet.end();
  const Image image = paper.frame.read();
  CHECK(inked(image) == std::array{20, 30, 49, 39});
  CHECK(channel(image, 35, 35, 0) == 255);
  CHECK(channel(image, 35, 35, 1) == 0);
  CHECK(channel(image, 35, 35, 3) == 255);
}

TEST_CASE("a clip rectangle cuts what lies outside it") {
  const Paper paper;
  Sheet sheet;
  ImDrawList& list = sheet.begin(200, 100);
  list.PushClipRect({60, 10}, {80, 25});
  list.AddRectFilled({0, 0}, {200, 100}, black);
  list.PopClipRect();
  sheet.end();
  CHECK(inked(paper.frame.read()) == std::array{60, 10, 79, 24});
}

TEST_CASE("more vertices than 16 bits can count are drawn in the right place") {
  const Paper paper;
  Sheet sheet;
  ImDrawList& list = sheet.begin(200, 100);
  for (int i = 0; i < 20000; ++i) list.AddRectFilled({5, 5}, {6, 6}, black);  // 80000 vertices
  list.AddRectFilled({150, 70}, {160, 80}, red);
  sheet.end();
  const Image image = paper.frame.read();
  CHECK(inked(image) == std::array{5, 5, 159, 79});
  CHECK(channel(image, 155, 75, 1) == 0);
  CHECK(channel(image, 100, 50, 1) == 255);
}

// Corners of a curve of curvature k may be sqrt(8 t / k) apart where it may be t away from it: 400 pixels of
// a wave of 30 pixels' height and 200 pixels' length (k up to 0.03) need some 60 at most.
TEST_CASE("a smooth curve on the screen has few corners, and is nowhere farther from its points than told") {
  constexpr float tolerance = 0.1f;
  std::vector<ImVec2> wave;
  for (int i = 0; i <= 2000; ++i)
    wave.emplace_back(0.2f * static_cast<float>(i), 30 * std::sin(0.0314f * 0.2f * static_cast<float>(i)));
  wave.insert(wave.begin() + 700, {ImVec2(139.9f, 70), ImVec2(139.95f, -80)});  // and two needles
  const std::vector<ImVec2> kept = plot::straightened(wave, tolerance);
  CHECK(kept.size() < 100);
  std::size_t next = 0;
  for (std::size_t k = 1; k < kept.size(); ++k) {
    const ImVec2 a = kept[k - 1], b = kept[k], d(b.x - a.x, b.y - a.y);
    const float length = std::hypot(d.x, d.y);
    for (; wave[next].x != b.x || wave[next].y != b.y; ++next) {
      REQUIRE(next + 1 < wave.size());
      const ImVec2 p(wave[next].x - a.x, wave[next].y - a.y);
      CHECK(std::abs(p.x * d.y - p.y * d.x) <= 1.001f * tolerance * length);  // 1e-3: single precision
      CHECK(p.x * d.x + p.y * d.y <= length * (length + tolerance));
    }
  }
  CHECK(next + 1 == wave.size());
  CHECK(plot::straightened(wave, 0).size() == wave.size());
}

TEST_CASE("text has its size, and fonts may be added between pictures") {
  const Paper paper;
  Sheet sheet;
  ImFont* small = sheet.font(16);
  sheet.begin(200, 100).AddText(small, 16, {10, 10}, black, "HHHH");
  sheet.end();
  const auto first = inked(paper.frame.read());
  paper.clear();
  ImFont* large = sheet.font(32);
  CHECK(sheet.font(16) == small);
  sheet.begin(200, 100).AddText(large, 32, {10, 10}, black, "HHHH");
  sheet.end();
  const auto second = inked(paper.frame.read());
  // A capital is about 0.63 of DejaVu's line height; within a pixel of anti-aliasing on either side.
  CHECK(first[3] - first[1] + 1 == Approx(0.63 * 16).margin(2));
  CHECK(second[3] - second[1] + 1 == Approx(0.63 * 32).margin(2));
  CHECK(second[2] - second[0] == Approx(2.0 * (first[2] - first[0])).margin(3));
}

TEST_CASE("Greek, minus, superscripts and arrows have glyphs") {
  const Paper paper;
  Sheet sheet;
  ImFont* font = sheet.font(16);
  sheet.begin(200, 100);
  for (const int letter : {0x03B8, 0x03BB, 0x2212, 0x207B, 0x00B9, 0x2075, 0x2192, 0x25A0, 0x00B0}) {
    INFO(letter);
    CHECK(font->FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr);
  }
  sheet.end();
}

TEST_CASE("letters that a text needs have glyphs, in fonts from before and after it") {
  const Paper paper;
  Sheet sheet;
  ImFont *before = sheet.font(16), *bold = sheet.font(16, true);
  sheet.begin(200, 100);  // the atlas is built
  sheet.end();
  CHECK(before->FindGlyphNoFallback(0x0416) == nullptr);
  sheet.need("\u0416\u1EBF \u05D0 \u6746 \U0001D4D0");  // Cyrillic, Vietnamese, Hebrew; no font has the rest
  sheet.need("\u0448");
  CHECK(sheet.font(16) == before);
  ImFont* after = sheet.font(20);
  const plot::TypefaceScope scope(*plot::find_typeface("helvetica"));
  ImFont* other = font_bytes(plot::typeface().file).empty() ? after : sheet.plot_font(18);
  sheet.begin(200, 100);
  for (const ImFont* font : {before, bold, after, other})
    for (const int letter : {0x0416, 0x1EBF, 0x05D0, 0x0448, 0x0041}) {
      CAPTURE(font->FontSize, letter);
      CHECK(font->FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr);
    }
  for (const ImFont* font : {before, after}) CHECK(font->FindGlyphNoFallback(0x6746) == nullptr);
  sheet.end();
}

TEST_CASE("labels in any letters that the font has are written in them") {
  const Paper paper;
  TextOverlay overlay;
  const auto written = [&](const std::string& text) {
    paper.clear();
    DrawList list;
    list.labels = {{10, 40, 16, {0, 0, 0, 1}, text}};
    overlay.draw(list, 200, 100);
    return paper.frame.read().rgba;
  };
  const auto first = written("\u0436");
  CHECK(first != written("\u0448"));
  CHECK(first != written("?"));
  CHECK(first == written("\u0436"));
}

// What a list looks like is its own affair, to the bit: the frames of a film that is drawn in parts are those
// of one that is drawn at once. A larger font moves the letters of a texture, and bilinear samples round
// elsewhere.
TEST_CASE("labels look the same whatever was written before them") {
  const Paper paper;
  const auto written = [&](TextOverlay& overlay, const std::vector<TextLabel>& labels) {
    paper.clear();
    DrawList list;
    list.labels = labels;
    overlay.draw(list, 200, 100);
    return paper.frame.read().rgba;
  };
  std::vector<TextLabel> labels;
  for (int i = 0; i < 12; ++i) {
    const auto row = static_cast<float>(i / 2), column = static_cast<float>(i % 2);
    labels.push_back(
        {100 * column, 16 * row, 7 + static_cast<float>(i) / 3, {0.2f, 0.3f, 0.4f, 1}, "Quick brown: 3.2 s"});
  }
  TextOverlay first, later;
  const auto alone = written(first, labels);
  written(later, {{100, 30, 40, {0, 0, 0, 1}, "Title \u0416", 0.5f, true}});
  CHECK((written(later, labels) == alone));
  std::reverse(labels.begin(), labels.end());
  CHECK((written(later, labels) == written(first, labels)));
}

TEST_CASE("labels are aligned to the left, the middle or the right of their place") {
  const Paper paper;
  TextOverlay overlay;
  const float align = GENERATE(0.0f, 0.5f, 1.0f);
  DrawList list;
  list.labels = {{100, 40, 16, {0, 0, 0, 1}, "label", align}};
  overlay.draw(list, 200, 100);
  const auto box = inked(paper.frame.read());
  const double width = box[2] - box[0] + 1;
  CHECK(width > 30);
  // Letters keep a pixel or so of white at both sides.
  CHECK(box[0] == Approx(100 - static_cast<double>(align) * width).margin(3));
  CHECK(box[1] >= 40);
  CHECK(box[3] < 40 + 20);
}

}  // namespace sheet_test
