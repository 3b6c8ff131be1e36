// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "render/plot/style.hpp"

namespace unfurl::plot {
namespace palette_test {

namespace {

using Rgb = std::array<double, 3>;  // linear

Rgb linear(FigureColor c) {
  const auto f = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return {f(c.r), f(c.g), f(c.b)};
}

// CIE 1976 L*a*b*, D65.
Rgb lab(const Rgb& c) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
  const double y = f(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// Machado, Oliveira and Fernandes (2009), severity 1: how people without one kind of cone see linear RGB.
const std::vector<std::array<Rgb, 3>> eyes{
    {Rgb{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {Rgb{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
    {Rgb{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
    {Rgb{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}};

Rgb seen(const std::array<Rgb, 3>& eye, const Rgb& c) {
  Rgb out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i] += eye[i][j] * c[j];
    out[i] = std::clamp(out[i], 0.0, 1.0);
  }
  return out;
}

double difference(const Rgb& a, const Rgb& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

TEST_CASE("every colour stands out from white", "[palette]") {
  for (int i = 0; i < palette_size; ++i) {
    CAPTURE(i);
    CHECK(contrast_on_white(palette(i)) >= 3.0);            // WCAG 2.1, 1.4.11: graphics
    CHECK(contrast_on_white(readable(palette(i))) >= 4.5);  // 1.4.3: text
  }
  CHECK(contrast_on_white({0, 0, 0, 1}) == Approx(21));
  CHECK(contrast_on_white(white) == Approx(1));
}

TEST_CASE("colours differ for every kind of eye", "[palette]") {
  for (std::size_t e = 0; e < eyes.size(); ++e) {
    for (int i = 0; i < palette_size; ++i) {
      for (int j = 0; j < i; ++j) {
        CAPTURE(e, i, j);
        // A difference of 2.3 is just noticeable side by side; four times that for thin lines apart.
        CHECK(difference(lab(seen(eyes[e], linear(palette(i)))), lab(seen(eyes[e], linear(palette(j))))) >
              9.2);
      }
    }
  }
}

TEST_CASE("palette indices go round", "[palette]") {
  CHECK(palette(2 * palette_size).r == palette(0).r);
  CHECK(palette(-1).g == palette(2 * palette_size - 1).g);
}

}  // namespace palette_test

}  // namespace unfurl::plot
