// SPDX-License-Identifier: BSD-3-Clause
// What is shown to people and written into XML of texts that hold anything.
#include "core/text/xml_text.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

using namespace unfurl;

namespace xml_text_test {

TEST_CASE("texts for a terminal keep letters, lines and tabs, and show what would control it") {
  CHECK(printable_text("a\tb\nc") == "a\tb\nc");
  CHECK(printable_text("\u00E9 \u4E16 \U0001F6F0") == "\u00E9 \u4E16 \U0001F6F0");
  CHECK(printable_text(std::string("a\0b", 3)) == "a\\x00b");
  CHECK(printable_text("\x1B[2J\r\x7F") == "\\x1b[2J\\x0d\\u007f");
  CHECK(printable_text("a\r\nb\r") ==
        "a\r\nb\\x0d");                          // the end of a line, and one that goes back to its begin
  CHECK(printable_text("\u0085") == "\\u0085");  // C1: next line, as JSON and TOML have it
  CHECK(printable_text("\u00A0") == "\u00A0");   // the first that is none
  CHECK(printable_text("\u202Ex\u2069") == "\\u202ex\\u2069");  // turns the direction of what follows
  CHECK(printable_text("\u2029\u202F") == "\u2029\u202F");      // neighbours of those
  CHECK(printable_text("\xFF\xC3(") == "\\xff\\xc3(");          // no UTF-8
}

TEST_CASE("texts in XML are what they were, without what XML cannot hold") {
  CHECK(xml_text("a < b & \"c\" > d") == "a &lt; b &amp; &quot;c&quot; &gt; d");
  CHECK(xml_text("\u00E9\n\u4E16") == "\u00E9\n\u4E16");
  CHECK(xml_text(std::string("a\0\x1B\x08"
                             "b",
                             5)) == "ab");
  CHECK(xml_text("\xFFx\uFFFEy\uFFFFz") == "xyz");
}

// XML 1.0, section 2.2 (but for a carriage return, which readers take for a line break), and Unicode's
// category Cc and its marks that turn the direction: every code point is what it was, or what stands for it.
TEST_CASE("every code point is kept in XML and on a terminal, or is one that neither may have") {
  for (char32_t c = 0; c <= 0x10FFFF; c += c < 0x3000 || (c > 0xFFF0 && c < 0x10010) ? 1 : 13) {
    if (c >= 0xD800 && c < 0xE000) continue;
    std::string text;
    const auto put = [&](char32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0 + c / 64), put(0x80 + c % 64);
    } else if (c < 0x10000) {
      put(0xE0 + c / 4096), put(0x80 + c / 64 % 64), put(0x80 + c % 64);
    } else {
      put(0xF0 + c / 262144), put(0x80 + c / 4096 % 64), put(0x80 + c / 64 % 64), put(0x80 + c % 64);
    }
    const std::string xml = xml_text(text), terminal = printable_text(text);
    const bool markup = c == '&' || c == '<' || c == '>' || c == '"';
    const bool none = (c < 0x20 && c != '\n') || c == 0xFFFD || c == 0xFFFE || c == 0xFFFF;
    if (xml != (markup ? xml : none ? "" : text) || (markup && (xml.size() < 4 || xml.back() != ';')))
      FAIL("XML has " << xml << " for " << static_cast<unsigned>(c));
    const bool control = (c < 0x20 && c != '\n' && c != '\t') || (c > 0x7E && c < 0xA0);
    const bool turns = (c > 0x2029 && c < 0x202F) || (c > 0x2065 && c < 0x206A);
    char code[16];
    std::snprintf(code, sizeof code, c > 0x7E ? "\\u%04x" : "\\x%02x", static_cast<unsigned>(c));
    if (terminal != (control || turns ? std::string(code) : text))
      FAIL("a terminal has " << terminal << " for " << static_cast<unsigned>(c));
  }
  CHECK(xml_text("\uFFFE\uFFFF\uFFFD").empty());
}

}  // namespace xml_text_test
