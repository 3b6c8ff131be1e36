// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/xml_text.hpp"

#include <cstdio>

#include "core/text/utf8.hpp"

namespace unfurl {

std::string xml_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = at;
    const char32_t c = next_code_point(text, at);
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if ((c >= 0x20 || c == '\n') && c != 0xFFFD && c != 0xFFFE && c != 0xFFFF)
      out += text.substr(from, at - from);
  }
  return out;
}

std::string printable_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = at;
    const char32_t c = next_code_point(text, at);
    const bool sequence = utf8_length(text, from) > 0;
    const bool line_end = c == '\r' && at < text.size() && text[at] == '\n';
    const bool control = (c < 0x20 && c != '\n' && c != '\t' && !line_end) || (c >= 0x7F && c < 0xA0);
    const bool turns = (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
    char code[16];
    if (sequence && !control && !turns) {
      out += text.substr(from, at - from);
      continue;
    }
    const auto number = sequence ? static_cast<unsigned>(c) : static_cast<unsigned char>(text[from]);
    // What TOML and JSON take for the character, where they have left it as it is.
    std::snprintf(code, sizeof code, sequence && c >= 0x7F ? "\\u%04x" : "\\x%02x", number);
    out += code;
  }
  return out;
}

}  // namespace unfurl
