// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/xml_text.hpp"

#include <catch2/catch.hpp>

namespace unfurl::xml_text_test {

TEST_CASE("what XML does not allow is escaped or left out", "[text]") {
  CHECK(xml_text("a<b>&\"c\"") == "a&lt;b&gt;&amp;&quot;c&quot;");
  CHECK(xml_text("tab\there\x01\xFF end") == "tabhere end");
  CHECK(xml_text("two\nlines") == "two\nlines");
  CHECK(xml_text("10\u207B\u00B9 \u03B8") == "10\u207B\u00B9 \u03B8");
  CHECK(xml_text("\xEF\xBF\xBE.\xEF\xBF\xBF.") == "..");  // U+FFFE, U+FFFF
}

}  // namespace unfurl::xml_text_test
