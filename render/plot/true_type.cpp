// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/true_type.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace unfurl::plot {
namespace {

void put16(std::string& out, unsigned v) {
  out += static_cast<char>(v >> 8 & 255);
  out += static_cast<char>(v & 255);
}
void put32(std::string& out, std::uint32_t v) {
  put16(out, v >> 16);
  put16(out, v & 0xFFFF);
}
void set32(std::string& out, std::size_t at, std::uint32_t v) {
  std::string text;
  put32(text, v);
  out.replace(at, 4, text);
}

// Sum of 32-bit words, the last one filled up with zeros.
std::uint32_t checksum(std::string_view bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    sum += static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * (3 - i % 4));
  return sum;
}

// The file of these tables: a directory, then each table at a multiple of four bytes.
std::string assemble(const std::map<std::string, std::string>& tables) {
  const auto count = static_cast<unsigned>(tables.size());
  unsigned power = 1, log = 0;
  while (2 * power <= count) power *= 2, ++log;
  std::string out;
  put32(out, 0x00010000);
  for (const unsigned v : {count, 16 * power, log, 16 * (count - power)}) put16(out, v);
  std::size_t at = 12 + 16 * tables.size(), head = 0;
  for (const auto& [tag, data] : tables) {
    out += tag;
    put32(out, checksum(data));
    put32(out, static_cast<std::uint32_t>(at));
    put32(out, static_cast<std::uint32_t>(data.size()));
    if (tag == "head") head = at;
    at += (data.size() + 3) / 4 * 4;
  }
  for (const auto& [tag, data] : tables) out += data, out.resize((out.size() + 3) / 4 * 4);
  set32(out, head + 8, 0xB1B0AFBA - checksum(out));  // checksumAdjustment, zero until now
  return out;
}

}  // namespace

TrueType::TrueType(std::string bytes) : bytes_(std::move(bytes)) {
  if (u32(0) != 0x00010000) throw std::runtime_error("not a TrueType font");
  for (unsigned i = 0; i < u16(4); ++i) {
    const std::size_t row = 12 + 16 * i;
    const Table t{u32(row + 8), u32(row + 12)};
    if (t.at + t.size > bytes_.size()) throw std::runtime_error("a font table runs out of the file");
    tables_[bytes_.substr(row, 4)] = t;
  }
  units_ = u16(table("head").at + 18);
  glyphs_ = static_cast<int>(u16(table("maxp").at + 4));
  widths_ = static_cast<int>(u16(table("hhea").at + 34));
  cmap_ = find_cmap();
  if (units_ == 0 || widths_ == 0 || cmap_ == 0) throw std::runtime_error("a font without characters");
}

unsigned TrueType::byte(std::size_t at) const {
  if (at >= bytes_.size()) throw std::runtime_error("the font file is cut off");
  return static_cast<unsigned char>(bytes_[at]);
}

const TrueType::Table& TrueType::table(const std::string& tag) const {
  const auto found = tables_.find(tag);
  if (found == tables_.end()) throw std::runtime_error("the font has no table " + tag);
  return found->second;
}

// The map from Unicode's first plane (platform 3, encoding 1, format 4); 0: none.
std::size_t TrueType::find_cmap() const {
  const std::size_t at = table("cmap").at;
  for (unsigned i = 0; i < u16(at + 2); ++i) {
    const std::size_t row = at + 4 + 8 * i, map = at + u32(row + 4);
    if (u16(row) == 3 && u16(row + 2) == 1 && u16(map) == 4) return map;
  }
  return 0;
}

int TrueType::glyph(char32_t c) const {
  const std::size_t twice = u16(cmap_ + 6), ends = cmap_ + 14, starts = ends + twice + 2;
  const std::size_t deltas = starts + twice, offsets = deltas + twice;
  for (std::size_t k = 0; k < twice; k += 2) {
    if (u16(ends + k) < c) continue;
    const unsigned first = u16(starts + k), offset = u16(offsets + k);
    if (c < first) return 0;
    unsigned id = static_cast<unsigned>(c);
    if (offset != 0) id = u16(offsets + k + offset + 2 * (static_cast<unsigned>(c) - first));
    if (offset != 0 && id == 0) return 0;
    return static_cast<int>((id + u16(deltas + k)) & 0xFFFF);
  }
  return 0;
}

double TrueType::advance(int glyph) const {
  const int i = std::clamp(glyph, 0, widths_ - 1);  // all behind the last one are as wide
  return u16(table("hmtx").at + 4 * static_cast<std::size_t>(i)) / units_;
}

TrueType::Box TrueType::bounds() const {
  const std::size_t head = table("head").at;
  return {i16(head + 36) / units_, i16(head + 38) / units_, i16(head + 40) / units_, i16(head + 42) / units_};
}

double TrueType::ascent() const {
  return i16(table("hhea").at + 4) / units_;
}
double TrueType::descent() const {
  return i16(table("hhea").at + 6) / units_;
}

TrueType::Table TrueType::outline(int glyph) const {
  const std::size_t loca = table("loca").at, i = static_cast<std::size_t>(glyph);
  const bool wide = i16(table("head").at + 50) != 0;
  const auto offset = [&](std::size_t k) -> std::size_t {
    return wide ? u32(loca + 4 * k) : 2 * u16(loca + 2 * k);
  };
  if (glyph < 0 || glyph >= glyphs_ || offset(i + 1) <= offset(i)) return {0, 0};
  return {table("glyf").at + offset(i), offset(i + 1) - offset(i)};
}

// The glyphs that a composite glyph (a letter with its accent) refers to.
void TrueType::add_parts(int glyph, std::set<int>& glyphs) const {
  const Table o = outline(glyph);
  if (o.size < 10 || i16(o.at) >= 0) return;
  unsigned flags = 0x20;
  for (std::size_t at = o.at + 10; flags & 0x20;) {  // MORE_COMPONENTS
    flags = u16(at);
    const int part = static_cast<int>(u16(at + 2));
    if (glyphs.insert(part).second) add_parts(part, glyphs);
    at += 4 + (flags & 0x01 ? 4u : 2u);  // ARG_1_AND_2_ARE_WORDS
    at += flags & 0x08 ? 2u : flags & 0x40 ? 4u : flags & 0x80 ? 8u : 0u;
  }
}

std::string TrueType::subset(std::set<int> glyphs) const {
  glyphs.insert(0);
  for (const int g : std::vector<int>(glyphs.begin(), glyphs.end())) add_parts(g, glyphs);
  std::map<std::string, std::string> out;
  for (const char* tag : {"cvt ", "fpgm", "head", "hhea", "hmtx", "maxp", "prep"})
    if (const auto t = tables_.find(tag); t != tables_.end())
      out[tag] = bytes_.substr(t->second.at, t->second.size);
  std::string &glyf = out["glyf"], &loca = out["loca"];
  for (int g = 0; g < glyphs_; ++g) {
    put32(loca, static_cast<std::uint32_t>(glyf.size()));
    if (!glyphs.count(g)) continue;
    const Table o = outline(g);
    glyf += bytes_.substr(o.at, o.size);
    glyf.resize((glyf.size() + 3) / 4 * 4);
  }
  put32(loca, static_cast<std::uint32_t>(glyf.size()));
  set32(out["head"], 8, 0);
  out["head"][51] = 1;  // indexToLocFormat: 32-bit
  return assemble(out);
}

}  // namespace unfurl::plot
