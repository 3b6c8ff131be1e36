// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/text/xml_text.hpp"
#include "render/plot/style.hpp"
#include "render/plot/svg_canvas.hpp"
#include "render/ui/write_figure.hpp"
#include "tests/render/plot/sample_figures.hpp"

namespace unfurl {
namespace {

// What keeps a document from being well-formed XML (elements, attributes, references); empty: nothing.
std::string xml_fault(const std::string& text) {
  std::vector<std::string> open;
  std::size_t at = text.find("?>") + 2, elements = 0;
  while (at < text.size()) {
    if (text[at] == '&') {
      const std::string reference = text.substr(at, text.find(';', at) - at + 1);
      if (reference != "&lt;" && reference != "&gt;" && reference != "&amp;" && reference != "&quot;")
        return "reference " + reference;
    }
    if (text[at] != '<') {
      if (open.empty() && !std::isspace(static_cast<unsigned char>(text[at]))) return "text outside the root";
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    for (bool quoted = false; end < text.size() && (quoted || text[end] != '>'); ++end) {
      if (text[end] == '"') quoted = !quoted;
      if (text[end] == '<') return "a < inside a tag";
    }
    const std::string tag = text.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" /", tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      if (open.empty() || "/" + open.back() != name) return "closes " + name;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    ++elements;
    at = end + 1;
  }
  if (!open.empty()) return "left open: " + open.back();
  return elements > 10 ? "" : "hardly anything there";
}

}  // namespace

TEST_CASE("every figure is well-formed SVG with its labels as text", "[svg]") {
  for (const Figure& figure : sample_figures()) {
    const std::string svg = figure_svg(figure);
    CAPTURE(figure.name);
    CHECK(xml_fault(svg) == "");
    CHECK(svg.find("width=\"160mm\"") != std::string::npos);
    CHECK(svg.find("DejaVu Sans") != std::string::npos);
    CHECK(svg.find(">" + xml_text(figure.title) + "</text>") != std::string::npos);
    CHECK(svg.find("nan") == std::string::npos);
    CHECK(svg.find("inf") == svg.find("infinities"));  // only as a word of the labels
    // A legend without room for all counts those that it leaves out.
    const bool counts = svg.find(" more</text>") != std::string::npos;
    CHECK(counts == figure.name.starts_with("many_"));
    for (const Panel& p : figure.panels)
      for (const Curve& c : p.curves)
        CHECK((c.label.empty() || counts ||
               svg.find(">" + xml_text(c.label) + "</text>") != std::string::npos));
  }
}

TEST_CASE("the check of XML finds faults", "[svg]") {
  const std::string svg = figure_svg(sample_figures().front());
  CHECK(xml_fault(svg + "</g>") != "");
  CHECK(xml_fault(svg.substr(0, svg.size() - 8)) != "");
  CHECK(xml_fault(std::string(svg).insert(svg.find("</text>"), " & ")) != "");
}

TEST_CASE("an SVG is written whole, and only known extensions are taken", "[svg]") {
  const std::filesystem::path dir =
      std::filesystem::temp_directory_path() / ("unfurl_svg_test_" + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  const Figure figure = sample_figures().front();
  write_figure(figure, dir / "a.svg");
  std::ifstream in(dir / "a.svg");
  std::stringstream text;
  text << in.rdbuf();
  CHECK(text.str() == figure_svg(figure));
  CHECK_THROWS_WITH(write_figure(figure, dir / "a.eps"),
                    Catch::Contains(".png") && Catch::Contains(".svg") && Catch::Contains("a.eps"));
  CHECK_FALSE(std::filesystem::exists(dir / "a.eps"));
  std::filesystem::remove_all(dir);
}

TEST_CASE("title and caption can be left out", "[svg]") {
  const Figure figure = sample_figures().front();
  const std::string svg = figure_svg(figure, *find_figure_style("single-column"));
  CHECK(svg.find(">" + figure.title + "</text>") == std::string::npos);
  CHECK(svg.find("<title>" + figure.title + "</title>") !=
        std::string::npos);  // still for search and readers
}

}  // namespace unfurl
