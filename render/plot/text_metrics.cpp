// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/text_metrics.hpp"

#include "core/text/utf8.hpp"
#include "render/plot/typeface.hpp"

namespace unfurl::plot {
namespace {

constexpr double unknown_advance = 0.6;

double advance(char32_t c) {
  if (const double own = typeface().advance(c); own > 0) return own;
  const double lent = typefaces().front().advance(c);
  return lent > 0 ? lent : c < 0x20 ? 0 : unknown_advance;
}

// The end of the word at `at`: a number, exponents and all, and its unit ("0.01 s.", "29 units") are one.
std::size_t word_end(std::string_view text, std::size_t at) {
  const auto digit = [](char c) { return (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80; };
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const std::size_t end = std::min(text.find(' ', at), text.size());
  if (end == at || end + 1 >= text.size() || !digit(text[end - 1]) || !letter(text[end + 1])) return end;
  return std::min(text.find(' ', end + 1), text.size());
}

}  // namespace

double text_width(std::string_view text, double size) {
  double sum = 0;
  for (std::size_t at = 0; at < text.size();) sum += advance(next_code_point(text, at));
  return sum * size;
}

Rect text_box(Point at, std::string_view text, const TextStyle& style) {
  const double width = text_width(text, style.size);
  const double before = style.anchor == Anchor::start    ? 0
                        : style.anchor == Anchor::middle ? width / 2
                                                         : width;
  const double up = ascent * style.size, down = descent * style.size;
  if (style.upward) return {at.x - up, at.y + before - width, at.x + down, at.y + before};
  return {at.x - before, at.y - up, at.x - before + width, at.y + down};
}

std::vector<std::string> wrap_text(std::string_view text, double size, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = word_end(text, at);
    const std::string word(text.substr(at, end - at));
    at = end + 1;
    const std::string longer = line.empty() ? word : line + ' ' + word;
    if (!line.empty() && text_width(longer, size) > width) {
      lines.push_back(std::move(line));
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(std::move(line));
  for (std::string& l : lines) l = shorten_text(l, size, width);
  return lines;
}

std::string shorten_text(std::string_view given, double size, double width) {
  std::string text(given);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';  // the end of a title's line
  if (text_width(text, size) <= width) return text;
  static constexpr std::string_view ellipsis = "\u2026";
  std::size_t keep = 0;
  for (std::size_t at = 0; at < text.size(); keep = at) {
    next_code_point(text, at);
    if (text_width(std::string_view(text).substr(0, at), size) + text_width(ellipsis, size) > width) break;
  }
  return text.substr(0, keep) + std::string(ellipsis);
}

}  // namespace unfurl::plot
