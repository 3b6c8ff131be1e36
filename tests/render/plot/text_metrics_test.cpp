// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/text_metrics.hpp"

#include <catch2/catch.hpp>

#include "core/text/utf8.hpp"
#include "render/ui/fonts.hpp"
#include "tests/support/not_tested.hpp"

namespace unfurl::plot {

TEST_CASE("the width table agrees with the typeface", "[text]") {
  ImFontAtlas atlas;
  const float pixels = 256;
  ImFont* font = add_font(atlas, pixels);
  unsigned char* data = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsAlpha8(&data, &width, &height);
  if (testing::lacks(font->FindGlyphNoFallback(0x2212) != nullptr,
                     "the typeface (apt-get install fonts-dejavu-core)"))
    return;
  for (const char* text : {"The quick brown fox, 0123456789", "\u221210\u207B\u00B9\u2075 \u00D7 \u00B0",
                           "\u03B1\u03B2\u03A9 \u201Cq\u201D"}) {
    double sum = 0;
    for (std::size_t at = 0; text[at] != 0;)
      sum += font->FindGlyph(static_cast<ImWchar>(next_code_point(text, at)))->AdvanceX;
    CAPTURE(text);
    CHECK(text_width(text, pixels / line_height) == Approx(sum).epsilon(1e-4));  // single precision sums
  }
}

TEST_CASE("UTF-8 is read by code points and bad bytes become U+FFFD", "[text]") {
  const auto points = [](std::string_view text) {
    std::u32string out;
    for (std::size_t at = 0; at < text.size();) out += next_code_point(text, at);
    return out;
  };
  CHECK(points("a\u00B0\u2212\U0001F600") == U"a\u00B0\u2212\U0001F600");
  CHECK(points("\xFF"
               "a") == U"\uFFFDa");
  CHECK(points("\xE2\x88") == U"\uFFFD\uFFFD");  // cut short
  CHECK(points("\xC0\x80").front() == U'\uFFFD');
}

TEST_CASE("wrapped lines fit and lose no word", "[text]") {
  const std::string text = "one two three four five six seven eight nine ten eleven twelve";
  const auto lines = wrap_text(text, 7, 80);
  std::string joined;
  for (const std::string& line : lines) {
    CHECK(text_width(line, 7) <= 80);
    joined += (joined.empty() ? "" : " ") + line;
  }
  CHECK(joined == text);
  CHECK(lines.size() > 2);
  CHECK(wrap_text("", 7, 80).empty());
  for (double width = 20; width < 120; width += 5)  // wherever lines end, a number keeps its unit
    for (const std::string& line : wrap_text("From 0.01 s to 29 units of 4.5 m.", 7, width)) {
      CAPTURE(width, line);
      CHECK_FALSE((line.back() >= '0' && line.back() <= '9'));
    }
  CHECK(text_width(wrap_text("unbreakable_word_that_is_far_too_long", 7, 50).at(0), 7) <= 50);
}

TEST_CASE("shortened text ends in an ellipsis and fits", "[text]") {
  CHECK(shorten_text("short", 7, 100) == "short");
  CHECK(shorten_text("two\nlines", 7, 100) == "two lines");
  const std::string cut = shorten_text("fold angle \u00B0\u00B0\u00B0\u00B0\u00B0\u00B0\u00B0", 7, 50);
  CHECK(text_width(cut, 7) <= 50);
  CHECK(cut.ends_with("\u2026"));
}

TEST_CASE("boxes follow anchor and direction", "[text]") {
  const double w = text_width("abc", 10);
  const Rect middle = text_box({100, 50}, "abc", {10, {}, Anchor::middle});
  CHECK(middle.x0 == Approx(100 - w / 2));
  CHECK(middle.x1 == Approx(100 + w / 2));
  CHECK(middle.y0 < 50);
  const Rect up = text_box({100, 50}, "abc", {10, {}, Anchor::start, true});
  CHECK(up.y1 == Approx(50));
  CHECK(up.y0 == Approx(50 - w));  // reads upwards
  CHECK(up.x0 < 100);
}

}  // namespace unfurl::plot
