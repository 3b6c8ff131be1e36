// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/fonts.hpp"

#include <string>

#include "render/plot/typeface.hpp"
#include "render/ui/font_file.hpp"

namespace unfurl {
namespace {

// ImGui keeps the pointer until the atlas is built: pairs of first and last code point, ended by 0.
constexpr ImWchar glyph_ranges[] = {0x0020, 0x017F,  // Latin, Latin-1, Latin Extended-A
                                    0x0370, 0x03FF,  // Greek
                                    0x2010, 0x2027,  // dashes, quotes, dots
                                    0x2030, 0x203A,  // per mille, primes
                                    0x2070, 0x209F,  // superscripts and subscripts
                                    0x2190, 0x21FF,  // arrows
                                    0x2200, 0x22FF,  // mathematics, minus among them
                                    0x25A0, 0x25FF,  // shapes
                                    0};
// Of what people write into the window's fields, too.
constexpr ImWchar window_ranges[] = {0x0020, 0x024F,  // Latin, with its Extended-B
                                     0x02B0, 0x02FF,  // modifier letters
                                     0x0370, 0x052F,  // Greek, Cyrillic
                                     0x1E00, 0x1EFF,  // Latin Extended Additional
                                     0x2010, 0x2027, 0x2030, 0x203A, 0x2070, 0x209F,
                                     0x2190, 0x22FF, 0x25A0, 0x25FF, 0x2700, 0x27BF,  // dingbats
                                     0};

// Null: these bytes are no font.
ImFont* add(ImFontAtlas& atlas, std::string_view bytes, ImFontConfig config, const ImWchar* ranges) {
  if (bytes.empty()) return nullptr;
  config.FontDataOwnedByAtlas = false;
  return atlas.AddFontFromMemoryTTF(const_cast<char*>(bytes.data()), static_cast<int>(bytes.size()),
                                    config.SizePixels, &config, ranges);
}

// ImGui sizes a font by its ascender and descender; its letters shall be as large as those of DejaVu Sans.
float same_letters(const plot::Typeface& face, float pixels) {
  return static_cast<float>(face.line_height / plot::typefaces().front().line_height) * pixels;
}

}  // namespace

ImFont* add_font(ImFontAtlas& atlas, float pixels, bool bold, Letters letters) {
  ImFontConfig config;
  config.SizePixels = pixels;
  const ImWchar* ranges = letters == Letters::window ? window_ranges : glyph_ranges;
  if (ImFont* font = add(atlas, own_font(bold), config, ranges)) return font;
  return atlas.AddFontDefault(&config);
}

bool is_common(char32_t c) {
  for (const ImWchar* range = glyph_ranges; *range != 0; range += 2)
    if (c >= range[0] && c <= range[1]) return true;
  return false;
}

// A glyph that a font has by now stays as it is.
void add_glyphs(ImFontAtlas& atlas, ImFont& font, float pixels, bool bold, const plot::Typeface& face,
                const ImWchar* ranges) {
  ImFontConfig config;
  config.MergeMode = true;
  config.DstFont = &font;
  const plot::Typeface& lender = plot::typefaces().front();
  if (&face != &lender) {
    config.SizePixels = same_letters(face, pixels);
    add(atlas, font_bytes(face.file), config, ranges);
  }
  config.SizePixels = pixels;
  if (bold) add(atlas, own_font(true), config, ranges);
  add(atlas, own_font(), config, ranges);
}

ImFont* add_plot_font(ImFontAtlas& atlas, float pixels) {
  const plot::Typeface &face = plot::typeface(), &lender = plot::typefaces().front();
  if (&face == &lender) return add_font(atlas, pixels);
  static ImVector<ImWchar> own, lent;  // as above: they outlive the atlas
  if (own.empty()) {
    ImFontGlyphRangesBuilder has, has_not;
    for (const ImWchar* range = glyph_ranges; *range != 0; range += 2)
      for (char32_t c = range[0]; c <= range[1]; ++c)
        (face.advance(c) > 0 ? has : has_not).AddChar(static_cast<ImWchar>(c));
    has.BuildRanges(&own);
    has_not.BuildRanges(&lent);
  }
  ImFontConfig config;
  config.SizePixels = same_letters(face, pixels);
  ImFont* font = add(atlas, font_bytes(face.file), config, own.Data);
  config.SizePixels = pixels;
  config.MergeMode = true;
  add(atlas, font_bytes(lender.file), config, lent.Data);
  return font;
}

}  // namespace unfurl
