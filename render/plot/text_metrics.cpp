// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/text_metrics.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/text/utf8.hpp"

namespace unfurl::plot {
namespace {

// Advance widths of DejaVu Sans 2.37 in 1/2048 of the size, in runs of consecutive code points.
struct Run {
  char32_t first;
  std::vector<std::int16_t> advance;
};
const std::vector<Run>& runs() {
  static const std::vector<Run> table{
      {0x20, {651,  821,  942,  1716, 1303, 1946, 1597, 563,  799,  799,  1024, 1716, 651,  739,  651,  690,
              1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 690,  690,  1716, 1716, 1716, 1087,
              2048, 1401, 1405, 1430, 1577, 1294, 1178, 1587, 1540, 604,  604,  1343, 1141, 1767, 1532, 1612,
              1235, 1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403, 1251, 1403, 799,  690,  799,  1716, 1024,
              1024, 1255, 1300, 1126, 1300, 1260, 721,  1300, 1298, 569,  569,  1186, 569,  1995, 1298, 1253,
              1300, 1300, 842,  1067, 803,  1298, 1212, 1675, 1212, 1212, 1075, 1303, 690,  1303, 1716}},
      {0xa0,
       {651,  821,  1303, 1303, 1303, 1303, 690,  1024, 1024, 2048, 965,  1253, 1716, 739,  2048, 1024,
        1024, 1716, 821,  821,  1024, 1303, 1303, 651,  1024, 821,  965,  1253, 1985, 1985, 1985, 1087,
        1401, 1401, 1401, 1401, 1401, 1401, 1995, 1430, 1294, 1294, 1294, 1294, 604,  604,  604,  604,
        1587, 1532, 1612, 1612, 1612, 1612, 1612, 1716, 1612, 1499, 1499, 1499, 1499, 1251, 1239, 1290,
        1255, 1255, 1255, 1255, 1255, 1255, 2011, 1126, 1260, 1260, 1260, 1260, 569,  569,  569,  569,
        1253, 1298, 1253, 1253, 1253, 1253, 1253, 1716, 1253, 1298, 1298, 1298, 1298, 1212, 1300, 1212}},
      {0x391,
       {1401, 1405, 1141, 1401, 1294, 1403, 1540, 1612, 604, 1343, 1401, 1767, 1532, 1294, 1612, 1540, 1235}},
      {0x3a3, {1294, 1251, 1251, 1612, 1403, 1612, 1565}},
      {0x3b1, {1350, 1307, 1212, 1253, 1107, 1114, 1298, 1253, 693,  1207, 1212, 1303, 1144,
               1142, 1253, 1233, 1300, 1202, 1298, 1233, 1185, 1351, 1183, 1351, 1715}},
      {0x2010, {739, 739, 1303, 1024, 2048, 2048}},
      {0x2018, {651, 651, 651, 651, 1061, 1061}},
      {0x2020, {1024, 1024, 1208}},
      {0x2026, {2048}},
      {0x2032, {465, 765}},
      {0x2070, {821}},
      {0x2074, {821, 821, 821, 821, 821, 821, 1081, 1081, 1081, 503, 503}},
      {0x2080, {821, 821, 821, 821, 821, 821, 821, 821, 821, 821, 1081, 1081, 1081, 503, 503}},
      {0x2190, {1716, 1716, 1716, 1716}},
      {0x2202, {1059}},
      {0x2206, {1370}},
      {0x2211, {1380, 1716}},
      {0x221a, {1305}},
      {0x221e, {1706}},
      {0x2225, {1024}},
      {0x222b, {1067}},
      {0x2248, {1716}},
      {0x2260, {1716}},
      {0x2264, {1716, 1716}},
      {0x22a5, {1784}},
  };
  return table;
}

constexpr double units = 2048.0, unknown_advance = 1229.0;

double advance(char32_t c) {
  const auto& table = runs();
  const auto after = std::upper_bound(table.begin(), table.end(), c,
                                      [](char32_t value, const Run& run) { return value < run.first; });
  if (after == table.begin()) return 0.0;
  const Run& run = *(after - 1);
  const std::size_t i = c - run.first;
  return i < run.advance.size() ? run.advance[i] : unknown_advance;
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
  return sum * size / units;
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

std::string shorten_text(std::string_view text, double size, double width) {
  if (text_width(text, size) <= width) return std::string(text);
  static constexpr std::string_view ellipsis = "\u2026";
  std::size_t keep = 0;
  for (std::size_t at = 0; at < text.size(); keep = at) {
    next_code_point(text, at);
    if (text_width(text.substr(0, at), size) + text_width(ellipsis, size) > width) break;
  }
  return std::string(text.substr(0, keep)) + std::string(ellipsis);
}

}  // namespace unfurl::plot
