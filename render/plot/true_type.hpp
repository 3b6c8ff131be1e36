// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace unfurl::plot {

// A TrueType font file: which glyph a character has, how wide it is, and a file with some of the glyphs only.
// After the OpenType specification 1.9, tables cmap (format 4), glyf, head, hhea, hmtx, loca, maxp.
class TrueType {
 public:
  // The file's bytes. Throws std::runtime_error where it is not such a font.
  explicit TrueType(std::string bytes);

  int glyph(char32_t c) const;      // 0: the font has none
  double advance(int glyph) const;  // relative to the size

  // Relative to the size.
  struct Box {
    double x0, y0, x1, y1;
  };
  Box bounds() const;
  double ascent() const, descent() const;  // the latter below 0

  // A font of the same numbers of glyphs in which all others are empty; glyph 0 and the parts that glyphs are
  // composed of are kept.
  std::string subset(std::set<int> glyphs) const;

 private:
  struct Table {
    std::size_t at, size;
  };
  unsigned byte(std::size_t at) const;
  unsigned u16(std::size_t at) const { return byte(at) << 8 | byte(at + 1); }
  int i16(std::size_t at) const { return static_cast<std::int16_t>(u16(at)); }
  std::uint32_t u32(std::size_t at) const { return u16(at) << 16 | u16(at + 2); }
  const Table& table(const std::string& tag) const;
  std::size_t find_cmap() const;
  Table outline(int glyph) const;  // in the file; size 0: blank
  void add_parts(int glyph, std::set<int>& glyphs) const;

  std::string bytes_;
  std::map<std::string, Table> tables_;
  int glyphs_ = 0, widths_ = 0;
  double units_ = 1;  // per em
  std::size_t cmap_ = 0;
};

}  // namespace unfurl::plot
