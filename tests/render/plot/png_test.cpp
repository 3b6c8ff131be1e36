// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <cmath>

#include "render/plot/style.hpp"
#include "render/ui/write_figure.hpp"
#include "tests/render/plot/sample_figures.hpp"

namespace unfurl {
namespace {

struct Pixel {
  int r, g, b;
};

Pixel pixel(const Image& image, double x, double y) {
  const auto i = 4 * (static_cast<std::size_t>(std::lround(y)) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(std::lround(x)));
  return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]};
}

// To within 2 of 255: rounding of colours and blending.
bool is(Pixel p, FigureColor c) {
  const auto near = [](int have, float want) { return std::abs(have - std::lround(255 * want)) <= 2; };
  return near(p.r, c.r) && near(p.g, c.g) && near(p.b, c.b);
}

// A thick line from the lower left to the upper right of a plain panel, and a level one.
Figure diagonal() {
  Figure f;
  f.width_mm = 80, f.height_mm = 60;
  Panel p;
  p.x.max = p.y.max = 10;
  Curve rising, level;
  for (int i = 0; i <= 10; ++i)
    rising.x.push_back(i), rising.y.push_back(i), level.x.push_back(i), level.y.push_back(2);
  rising.color = 0, level.color = 1;
  rising.width = level.width = 3;
  p.curves = {rising, level};
  f.panels.push_back(p);
  return f;
}

}  // namespace

TEST_CASE("a painted curve has its colour where its axes say", "[png]") {
  const Figure figure = diagonal();
  FigureWriter writer;
  const Image image = writer.paint(figure);
  REQUIRE(image.width == 945);  // 80 mm at 300 dpi
  REQUIRE(image.height == 709);
  const plot::FigureLayout layout = plot::lay_out(figure);
  const plot::PanelLayout& p = layout.panels[0];
  const double k = 300.0 / 72.0;
  const auto at = [&](double x, double y) {
    return pixel(image, k * p.x.scale(x) - 0.5, k * p.y.scale(y) - 0.5);
  };
  for (const double v : {1.0, 4.5, 7.0, 9.5}) CHECK(is(at(v, v), palette(0)));
  for (const double v : {0.5, 4.5, 9.5}) CHECK(is(at(v, 2), palette(1)));
  CHECK(is(at(3.3, 7.7), plot::white));
  CHECK(is(pixel(image, 2, 2), plot::white));
  CHECK(is(pixel(image, image.width - 3, image.height - 3), plot::white));
}

TEST_CASE("a title in letters that no figure had before is written in them", "[png]") {
  FigureWriter writer;
  const auto painted = [&](const char* label) {
    Figure figure = diagonal();
    figure.panels[0].y.label = label;
    return writer.paint(figure).rgba;
  };
  const auto first = painted("\u0441\u0442\u0435\u0440");  // as wide as the next one
  CHECK(first != painted("\u0442\u0441\u0435\u0440"));
  CHECK(first != painted("????"));
  CHECK(first == painted("\u0441\u0442\u0435\u0440"));
}

TEST_CASE("text is painted: tick labels leave ink left of the axis", "[png]") {
  const Figure figure = diagonal();
  FigureWriter writer;
  const Image image = writer.paint(figure);
  const plot::FigureLayout layout = plot::lay_out(figure);
  for (const plot::Label& label : layout.panels[0].labels) {
    CAPTURE(label.text);
    int dark = 0;
    const double k = 300.0 / 72.0;
    for (double y = label.at.y - 5; y < label.at.y; y += 0.2)
      for (double x = label.at.x - 6; x < label.at.x + 6; x += 0.2)
        dark += pixel(image, k * x, k * y).r < 150;
    CHECK(dark > 10);
  }
}

TEST_CASE("a noisy line of 40 000 points is painted where it belongs and nowhere else", "[png]") {
  Figure figure = diagonal();
  Curve noise;
  for (int i = 0; i < 40000; ++i)
    noise.x.push_back(i * 2.5e-4), noise.y.push_back(4 + (i * 7919 % 1000) * 1e-3);
  noise.width = 0.5f;
  figure.panels[0].curves = {noise};
  FigureWriter writer;
  const Image image = writer.paint(figure);
  const plot::FigureLayout layout = plot::lay_out(figure);
  const plot::PanelLayout& p = layout.panels[0];
  const double k = 300.0 / 72.0;
  int inside = 0, outside = 0;
  for (double x = 0.3; x < 9.8; x += 0.05) {
    inside += is(pixel(image, k * p.x.scale(x), k * p.y.scale(4.5)), palette(0));
    for (const double y : {1.0, 3.0, 6.1, 9.0})
      outside += is(pixel(image, k * p.x.scale(x), k * p.y.scale(y)), palette(0));
  }
  CHECK(inside > 150);  // of 190
  CHECK(outside == 0);
}

TEST_CASE("one writer paints figures of several sizes", "[png]") {
  FigureWriter writer({.dpi = 72});
  for (const Figure& figure : sample_figures()) {
    const Image image = writer.paint(figure);
    CHECK(image.width == std::lround(figure.width_mm * plot::points_per_mm));
    CHECK(image.height == std::lround(figure.height_mm * plot::points_per_mm));
    int dark = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) dark += image.rgba[i] < 128;
    CHECK(dark > 200);  // axes and text at least
  }
}

}  // namespace unfurl
