// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/wrapped.hpp"

#include <algorithm>

namespace unfurl {

std::size_t characters_in(std::string_view text) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins));
}

std::string wrapped(std::string_view text, std::size_t width, std::string_view first, std::string_view next) {
  std::string lines, line(first);
  bool empty = true;  // no word stands in the line yet
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (!empty && characters_in(line) + 1 + characters_in(word) > width) {
      lines += line + "\n";
      line = next;
      empty = true;
    }
    line += (empty ? "" : " ") + std::string(word);
    empty = false;
  }
  return lines + line + "\n";
}

}  // namespace unfurl
