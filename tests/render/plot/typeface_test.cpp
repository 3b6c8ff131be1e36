// SPDX-License-Identifier: BSD-3-Clause
// Figures in other typefaces: their widths, and the three kinds of files.
#include "render/plot/typeface.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "render/plot/text_metrics.hpp"
#include "render/plot/true_type.hpp"
#include "render/ui/write_figure.hpp"
#include "tests/render/plot/sample_figures.hpp"
#include "tests/support/not_tested.hpp"

namespace unfurl {
namespace {

const plot::Typeface& helvetica() {
  return *plot::find_typeface("helvetica");
}

bool there(const plot::Typeface& face) {
  return !testing::lacks(std::filesystem::is_regular_file(face.file),
                         "a typeface (apt-get install " + std::string(face.package) + ")");
}

plot::TrueType file_of(const plot::Typeface& face) {
  std::ifstream in(face.file, std::ios::binary);
  return plot::TrueType(std::string(std::istreambuf_iterator<char>(in), {}));
}

}  // namespace

TEST_CASE("every typeface's table of widths is that of its file", "[text]") {
  for (const plot::Typeface& face : plot::typefaces()) {
    if (!there(face)) continue;
    const plot::TrueType file = file_of(face);
    int known = 0;
    for (char32_t c = 0x20; c < 0x2300; ++c) {
      if (face.advance(c) == 0) continue;
      CAPTURE(face.name, static_cast<unsigned>(c));
      REQUIRE(file.glyph(c) != 0);
      CHECK(face.advance(c) == Approx(file.advance(file.glyph(c))));
      ++known;
    }
    CHECK(known > 200);
  }
}

// Adobe's metrics of Helvetica, in thousandths of the size; Liberation Sans rounds to 1/2048.
TEST_CASE("the typeface that stands for Helvetica is as wide as it", "[text]") {
  const plot::TypefaceScope scope(helvetica());
  for (const auto& [text, width] :
       {std::pair("A", 667), std::pair("W", 944), std::pair("i", 222), std::pair("m", 833),
        std::pair("5", 556), std::pair("%", 889), std::pair("s", 500), std::pair(" ", 278)})
    CHECK(plot::text_width(text, 1) == Approx(1e-3 * width).margin(1e-3));
}

TEST_CASE("a figure in another typeface is so in SVG, PDF and PNG, exponents in one face", "[figures]") {
  if (!there(helvetica()) || !there(plot::typefaces().front())) return;
  const Figure figure = sample_figures()[2];  // with powers of ten
  const auto folder = std::filesystem::temp_directory_path() / "unfurl_typeface_test";
  std::filesystem::create_directories(folder);
  const auto text_of = [&](const std::string& name, const plot::Typeface& face) {
    FigureWriter writer({.dpi = 72, .face = &face});
    writer.write(figure, folder / name);
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const plot::Typeface& own = plot::typefaces().front();
  const std::string svg = text_of("a.svg", helvetica()), plain = text_of("b.svg", own);
  CHECK(svg.find("font-family=\"Helvetica, Arial") != std::string::npos);
  CHECK(plain.find("Helvetica") == std::string::npos);
  CHECK(plain.find("<tspan") == std::string::npos);
  // The whole exponent is lent: no digit of it is left to a face that has but three of them.
  CHECK(svg.find("10<tspan font-family=\"'DejaVu Sans'") != std::string::npos);
  for (const char* digit : {"\u00B9", "\u00B2", "\u2075"})
    CHECK(svg.find(std::string("10") + digit) == std::string::npos);
  const std::string pdf = text_of("a.pdf", helvetica());
  CHECK(pdf.find("+LiberationSans") != std::string::npos);
  CHECK(pdf.find("+DejaVuSans") != std::string::npos);
  CHECK(text_of("b.pdf", own).find("Liberation") == std::string::npos);
  CHECK(text_of("a.png", helvetica()) != text_of("b.png", own));
  CHECK(text_of("a.png", helvetica()) == text_of("a.png", helvetica()));
  CHECK(&plot::typeface() == &own);  // as before
  std::filesystem::remove_all(folder);
}

TEST_CASE("a typeface that is not installed is an error with its package", "[figures]") {
  plot::Typeface missing = helvetica();
  missing.file = "/nowhere/font.ttf";
  CHECK_THROWS_WITH(FigureWriter({.face = &missing}), Catch::Contains("fonts-liberation"));
}

}  // namespace unfurl
