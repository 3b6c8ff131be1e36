// SPDX-License-Identifier: BSD-3-Clause
// Text as code points.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace unfurl {

// Length of the UTF-8 sequence at byte `at` (RFC 3629: no overlong forms, no surrogates, at most U+10FFFF); 0
// where it is none.
std::size_t utf8_length(std::string_view text, std::size_t at);

// The code point at byte `at`, which moves behind it; U+FFFD for a byte that begins no UTF-8 sequence.
char32_t next_code_point(std::string_view text, std::size_t& at);

// Bytes of the longest beginning that has at most `most` bytes and ends where a character does.
std::size_t utf8_cut(std::string_view text, std::size_t most);

// The same text in UTF-16: two units (surrogates) beyond U+FFFF.
std::u16string utf16(std::string_view utf8);

}  // namespace unfurl
