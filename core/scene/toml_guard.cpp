// SPDX-License-Identifier: BSD-3-Clause
// What is checked before the TOML library sees a text. Release 3.3.0 of the library runs past its buffer on
// bytes that are nearly a byte-order mark (EF BB 9F), and destroys deeply nested tables recursively, so that
// one line of dotted keys can exhaust the stack.
#include <algorithm>
#include <array>

#include "core/scene/toml_tree.hpp"
#include "core/text/utf8.hpp"

namespace unfurl {

std::size_t string_end(std::string_view text, std::size_t i) {
  const char quote = text[i];
  const std::array<char, 3> three = {quote, quote, quote};
  const std::string_view triple(three.data(), three.size());
  const bool multi = text.substr(i).starts_with(triple);
  for (i += multi ? 3 : 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (!multi && (text[i] == quote || text[i] == '\n')) {
      return i + (text[i] == quote ? 1 : 0);
    } else if (multi && text.substr(i).starts_with(triple)) {
      i += 3;
      for (int extra = 0; extra < 2 && i < text.size() && text[i] == quote; ++extra) ++i;
      return i;
    }
  }
  return text.size();
}

namespace {

constexpr std::size_t max_brackets = 64;  // a scene needs 3
constexpr std::size_t max_dots = 16;      // dots in one key; a scene needs 2

TextObstacle find_deep_nesting(std::string_view text) {
  std::size_t brackets = 0, dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '#':
        i = std::min(text.find('\n', i), text.size()) - 1;
        break;
      case '"':
      case '\'':
        i = string_end(text, i) - 1;
        break;
      case '[':
      case '{':
        if (++brackets > max_brackets) return {i, "brackets nested too deeply"};
        dots = 0;
        break;
      case ']':
      case '}':
        if (brackets > 0) --brackets;
        break;
      case '.':
        if (++dots > max_dots) return {i, "a key with too many dots"};
        break;
      case '\n':
      case '=':
      case ',':
        dots = 0;
        break;
      default:
        break;
    }
  }
  return {};
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  return text.substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
}

TextObstacle find_bad_encoding(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return {0, "the file is UTF-16 (it starts with that byte-order mark); save it as UTF-8"};
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '\0') return {i, "a zero byte: this is not a text file in UTF-8"};
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return {i, "not valid UTF-8"};
    i += length;
  }
  return {};
}

TextObstacle find_toml_obstacle(std::string_view text) {
  TextObstacle obstacle = find_bad_encoding(text);
  return obstacle.message.empty() ? find_deep_nesting(text) : obstacle;
}

SourceLocation locate(std::string_view text, std::size_t offset, const std::string& file) {
  SourceLocation where{file, 1, 1};
  for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) {
    if (text[i] == '\n') {
      ++where.line;
      where.column = 1;
    } else if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) {
      ++where.column;
    }
  }
  return where;
}

}  // namespace unfurl
