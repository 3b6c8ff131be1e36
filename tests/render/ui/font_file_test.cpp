// SPDX-License-Identifier: BSD-3-Clause
// A font is found where it is, not only where Debian has it.
#include "render/ui/font_file.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

using namespace unfurl;
namespace fs = std::filesystem;

namespace font_file_test {

TEST_CASE("a font is taken from UNFURL_FONTS where Debian's place has none") {
  const fs::path folder = fs::temp_directory_path() / "unfurl_fonts_test";
  fs::create_directories(folder / "of/somebody");
  const fs::path own = folder / "of/somebody/Somebodys.ttf";
  fs::copy_file(font_file(), own, fs::copy_options::overwrite_existing);
  CHECK(found_font("/nowhere/Somebodys.ttf").empty());
  ::setenv("UNFURL_FONTS", folder.c_str(), 1);
  CHECK(found_font("/nowhere/Somebodys.ttf") == own.string());  // what was not found is looked for again
  CHECK(found_font("/nowhere/Nobodys.ttf").empty());
  CHECK(found_font(own.string()) == own.string());
  ::unsetenv("UNFURL_FONTS");
  fs::remove_all(folder);
}

}  // namespace font_file_test
