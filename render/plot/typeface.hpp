// SPDX-License-Identifier: BSD-3-Clause
// The typefaces of figures. To add one: a row and its widths in typeface.cpp.
#pragma once

#include <span>
#include <string_view>

namespace unfurl::plot {

struct Typeface {
  std::string_view name, help;
  const char* file;     // where Debian has it
  const char* package;  // which brings it
  std::string_view pdf_name;
  std::string_view families;  // of CSS, the first one that a viewer has
  double line_height;         // ascender to descender as the file says, relative to the size

  // Relative to the size; 0: it has no such character. Superscripts are all of one face: ¹ ² ³ alone are
  // none.
  double advance(char32_t c) const;
};

// The first one is the default, and lends the others what they have not.
std::span<const Typeface> typefaces();
const Typeface* find_typeface(std::string_view name);  // nullptr where there is none

// That in which this thread lays figures out and draws them.
const Typeface& typeface();

// While it lives, typeface() is another one.
class TypefaceScope {
 public:
  explicit TypefaceScope(const Typeface& face);
  ~TypefaceScope();
  TypefaceScope(const TypefaceScope&) = delete;
  TypefaceScope& operator=(const TypefaceScope&) = delete;

 private:
  const Typeface* outer_;
};

}  // namespace unfurl::plot
