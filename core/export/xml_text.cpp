#include "core/export/xml_text.hpp"

#include "core/model/utf8.hpp"

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

}  // namespace unfurl
