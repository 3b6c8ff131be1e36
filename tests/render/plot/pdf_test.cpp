// SPDX-License-Identifier: BSD-3-Clause
// PDF figures, read by poppler where it is installed and by a small reader of our own in any case.
#include <zlib.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <regex>

#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/plot/true_type.hpp"
#include "render/ui/font_file.hpp"
#include "render/ui/write_figure.hpp"
#include "tests/render/plot/sample_figures.hpp"
#include "tests/support/not_tested.hpp"

namespace unfurl {
namespace {

const plot::TrueType& font() {
  static const plot::TrueType f{std::string(own_font())};
  return f;
}

std::string inflated(const std::string& packed) {
  std::string out(16u << 20, '\0');
  uLongf size = out.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                     reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  out.resize(size);
  return out;
}

// The n-th stream of the file, by the length that its dictionary states.
std::string stream(const std::string& pdf, int n) {
  std::size_t at = 0;
  for (int k = 0;; ++k) {
    at = pdf.find("/Length ", at);
    REQUIRE(at != std::string::npos);
    const auto length = static_cast<std::size_t>(std::stoul(pdf.substr(at + 8)));
    const std::size_t from = pdf.find("stream\n", at) + 7;
    REQUIRE(pdf.compare(from + length, 10, "\nendstream") == 0);
    if (k == n) return inflated(pdf.substr(from, length));
    at = from + length;
  }
}

// The output of a program; empty where it is not installed.
std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  REQUIRE(pipe != nullptr);
  char part[4096];
  for (std::size_t n; (n = std::fread(part, 1, sizeof part, pipe)) > 0;) out.append(part, n);
  pclose(pipe);
  return out;
}

}  // namespace

TEST_CASE("PDF figures are whole: every object is where the table says", "[pdf]") {
  for (const Figure& figure : sample_figures()) {
    const std::string pdf = figure_pdf(figure);
    CAPTURE(figure.name);
    CHECK(pdf.starts_with("%PDF-1."));
    CHECK(pdf.ends_with("%%EOF\n"));
    const auto table = static_cast<std::size_t>(std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10)));
    REQUIRE(pdf.compare(table, 5, "xref\n") == 0);
    const int count = std::stoi(pdf.substr(table + 7));
    const std::size_t first = pdf.find('\n', table + 7) + 1;  // rows of 20 bytes
    for (int i = 1; i < count; ++i) {
      const auto at =
          static_cast<std::size_t>(std::stoul(pdf.substr(first + 20 * static_cast<std::size_t>(i), 10)));
      const std::string head = std::to_string(i) + " 0 obj\n";
      CHECK(pdf.compare(at, head.size(), head) == 0);
    }
    CHECK(stream(pdf, 0).find("nan") == std::string::npos);
    CHECK(pdf.find("/FontFile2") != std::string::npos);
    CHECK(pdf == figure_pdf(figure));
  }
}

TEST_CASE("a PDF page is as large as the style says", "[pdf]") {
  const std::string pdf = figure_pdf(sample_figures().front(), *find_figure_style("single-column"));
  const std::size_t at = pdf.find("/MediaBox [0 0 ") + 15;
  CHECK(std::stod(pdf.substr(at)) == Approx(89 * plot::points_per_mm).margin(0.001));  // three decimals
}

TEST_CASE("the font's widths are those that the layout counts with", "[pdf]") {
  for (const char32_t c : std::u32string(U"AMil0 9,.()°µθ−×⁻⁵²“”"))
    CHECK(font().advance(font().glyph(c)) == Approx(plot::text_width(
                                                 [&] {
                                                   std::string s;
                                                   if (c < 0x80)
                                                     s += static_cast<char>(c);
                                                   else if (c < 0x800)
                                                     s += static_cast<char>(0xC0 | c >> 6),
                                                         s += static_cast<char>(0x80 | (c & 63));
                                                   else
                                                     s += static_cast<char>(0xE0 | c >> 12),
                                                         s += static_cast<char>(0x80 | (c >> 6 & 63)),
                                                         s += static_cast<char>(0x80 | (c & 63));
                                                   return s;
                                                 }(),
                                                 1.0)));
  CHECK(font().glyph(U'\U0010FFFF') == 0);
}

TEST_CASE("a subset of a font keeps its glyphs, its numbers and little else", "[pdf]") {
  const int a = font().glyph(U'a'), umlaut = font().glyph(U'\u00E4');
  const std::string file = font().subset({a, umlaut});
  CHECK(file.size() < 120000);  // the whole is 757 kB; 25 kB each of widths and 4-byte places remain
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < file.size(); ++i)
    sum += static_cast<std::uint32_t>(static_cast<unsigned char>(file[i])) << (8 * (3 - i % 4));
  CHECK(sum == 0xB1B0AFBA);  // OpenType: the sum of a whole font file
}

TEST_CASE("files that are no fonts are refused", "[pdf]") {
  CHECK_THROWS_AS(plot::TrueType("no font"), std::runtime_error);
  CHECK_THROWS_AS(plot::TrueType(std::string(own_font()).substr(0, 3000)), std::runtime_error);
}

TEST_CASE("poppler finds the font embedded and the text as text", "[pdf]") {
  const auto folder = std::filesystem::temp_directory_path();
  const std::filesystem::path path =
      folder / ("unfurl_pdf_test_" + std::to_string(std::hash<std::string>{}(folder.string())) + ".pdf");
  const Figure figure = sample_figures()[2];
  write_figure(figure, path);
  const std::string fonts = output_of("pdffonts " + path.string());
  if (!testing::lacks(!fonts.empty(), "PDF as poppler reads it (apt-get install poppler-utils)")) {
    CHECK(std::regex_search(fonts, std::regex("DejaVuSans +CID TrueType +Identity-H +yes yes yes")));
    const std::string text = output_of("pdftotext -layout " + path.string() + " -");
    CHECK(text.find(figure.title) != std::string::npos);
    CHECK(text.find("10\u207B\u00B9\u2074") != std::string::npos);
    CHECK(text.find("velocity error (m/s)") != std::string::npos);
  }
  std::filesystem::remove(path);
}

}  // namespace unfurl
