// SPDX-License-Identifier: BSD-3-Clause
// What is shown to people and written into XML of texts that hold anything.
#include "core/text/xml_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace unfurl;

namespace xml_text_test {

TEST_CASE("texts for a terminal keep letters, lines and tabs, and show what would control it") {
  CHECK(printable_text("a\tb\nc") == "a\tb\nc");
  CHECK(printable_text("\u00E9 \u4E16 \U0001F6F0") == "\u00E9 \u4E16 \U0001F6F0");
  CHECK(printable_text(std::string("a\0b", 3)) == "a\\x00b");
  CHECK(printable_text("\x1B[2J\r\x7F") == "\\x1b[2J\\x0d\\x7f");
  CHECK(printable_text("\u0085") == "\\x85");                   // C1: next line
  CHECK(printable_text("\u00A0") == "\u00A0");                  // the first that is none
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

}  // namespace xml_text_test
