// SPDX-License-Identifier: BSD-3-Clause
// A font is found where it is, not only where Debian has it.
#include "render/ui/font_file.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace unfurl;
namespace fs = std::filesystem;

namespace font_file_test {

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_CASE("a font is taken from UNFURL_FONTS where Debian's place has none") {
  const fs::path folder = fs::temp_directory_path() / "unfurl_fonts_test";
  fs::create_directories(folder / "of/somebody");
  const fs::path own = folder / "of/somebody/Somebodys.ttf";
  std::ofstream(own) << "glyphs";
  CHECK(font_bytes("/nowhere/Somebodys.ttf").empty());
  ::setenv("UNFURL_FONTS", folder.c_str(), 1);
  CHECK(font_bytes("/nowhere/Somebodys.ttf") == "glyphs");  // what was not found is looked for again
  CHECK(font_bytes("/nowhere/Nobodys.ttf").empty());
  CHECK(font_bytes(own.string()) == "glyphs");
  ::unsetenv("UNFURL_FONTS");
  fs::remove_all(folder);
}

TEST_CASE("the program's own typeface needs no font on the machine") {
  for (const bool bold : {false, true}) {
    const std::string name = bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
    CHECK(font_bytes("/nowhere/" + name) == own_font(bold));
    CHECK(own_font(bold) == content("/usr/share/fonts/truetype/dejavu/" + name));  // where this was built
  }
}

}  // namespace font_file_test
