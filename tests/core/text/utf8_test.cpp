// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/utf8.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace unfurl::utf8_test {

// The code points of RFC 3629, section 7, and the ends of each length's range (section 3).
TEST_CASE("code points of every length are read whole", "[text]") {
  const struct {
    std::string text;
    char32_t c;
  } rows[] = {{"A", 0x41},
              {"\x7F", 0x7F},
              {"\xC2\x80", 0x80},
              {"\xDF\xBF", 0x7FF},
              {"\xE0\xA0\x80", 0x800},
              {"\xE6\x97\xA5", 0x65E5},
              {"\xED\x9F\xBF", 0xD7FF},
              {"\xEE\x80\x80", 0xE000},
              {"\xEF\xBF\xBF", 0xFFFF},
              {"\xF0\x90\x80\x80", 0x10000},
              {"\xF0\xA3\x8E\xB4", 0x233B4},
              {"\xF4\x8F\xBF\xBF", 0x10FFFF}};
  for (const auto& row : rows) {
    std::size_t at = 1;
    CAPTURE(row.text);
    CHECK(utf8_length("x" + row.text + "y", 1) == row.text.size());
    CHECK(next_code_point("x" + row.text + "y", at) == row.c);
    CHECK(at == 1 + row.text.size());
  }
}

TEST_CASE("bytes that are no UTF-8 are passed one by one", "[text]") {
  // Overlong forms, surrogates, beyond U+10FFFF, a lone continuation, sequences cut short.
  for (const std::string bad : {"\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xED\xBF\xBF",
                                "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\x80", "\xFF",
                                "\xC3", "\xE2\x82", "\xF0\x9F\x98", "\xE2\x82z"}) {
    std::size_t at = 0;
    CAPTURE(bad);
    CHECK(utf8_length(bad, 0) == 0);
    CHECK(next_code_point(bad, at) == 0xFFFD);
    CHECK(at == 1);
  }
}

// RFC 3629, section 3: the bits of the table, put together without the code that takes them apart.
TEST_CASE("every code point is read back, and no other three bytes are one", "[text]") {
  std::size_t wrong = 0, three = 0;
  for (char32_t c = 0; c <= 0x10FFFF; ++c) {
    if (c >= 0xD800 && c < 0xE000) continue;
    std::string text;
    const auto put = [&](char32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0 + c / 64), put(0x80 + c % 64);
    } else if (c < 0x10000) {
      put(0xE0 + c / 4096), put(0x80 + c / 64 % 64), put(0x80 + c % 64), ++three;
    } else {
      put(0xF0 + c / 262144), put(0x80 + c / 4096 % 64), put(0x80 + c / 64 % 64), put(0x80 + c % 64);
    }
    std::size_t at = 0;
    wrong += utf8_length(text, 0) != text.size() || next_code_point(text, at) != c || at != text.size();
  }
  CHECK(wrong == 0);
  // As many threes as there are points of three bytes: none too many.
  std::size_t found = 0;
  std::string bytes(3, ' ');
  for (unsigned lead = 0xE0; lead < 0xF0; ++lead)
    for (unsigned rest = 0; rest < 0x10000; ++rest) {
      bytes = {static_cast<char>(lead), static_cast<char>(rest >> 8U), static_cast<char>(rest & 0xFFU)};
      found += utf8_length(bytes, 0) == 3;
    }
  CHECK(found == three);
}

// RFC 2781, section 5, and the ends of what one unit and what two hold.
TEST_CASE("UTF-16 has a unit for what is below U+10000, and surrogates beyond", "[text]") {
  CHECK(utf16("Fu\xC3\x9F \xE4\xB8\xAD") == u"Fu\u00DF \u4E2D");
  CHECK(utf16("\xEF\xBF\xBF") == u"\uFFFF");
  CHECK(utf16("\xF0\x90\x80\x80") == std::u16string{0xD800, 0xDC00});
  CHECK(utf16("\xF0\x92\x8D\x85=Ra") == std::u16string{0xD808, 0xDF45, u'=', u'R', u'a'});
  CHECK(utf16("\xF4\x8F\xBF\xBF") == std::u16string{0xDBFF, 0xDFFF});
  CHECK(utf16("a\xFFz") == u"a\uFFFDz");
  CHECK(utf16("").empty());
}

}  // namespace unfurl::utf8_test
