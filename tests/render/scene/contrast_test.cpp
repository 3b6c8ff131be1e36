// SPDX-License-Identifier: BSD-3-Clause
// What is written over a picture can be read: 4.5 to 1 for text, 3 to 1 for signs (WCAG 2.1, 1.4.3
// and 1.4.11).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/look.hpp"

using namespace unfurl;

namespace contrast_test {

namespace {

double luminance(const Color& c) {
  const auto linear = [](float x) {
    const auto v = static_cast<double>(x);
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

double contrast(const Color& a, const Color& b) {
  const double x = luminance(a), y = luminance(b);
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

Color over(const Color& top, const Color& below) {
  const auto mix = [&](float t, float b) { return t * top.a + b * (1 - top.a); };
  return {mix(top.r, below.r), mix(top.g, below.g), mix(top.b, below.b), 1};
}

bool is_sign(const TextLabel& label) {
  return label.text == "\u2192";
}

}  // namespace

TEST_CASE("texts of every look can be read, also over shadow, floor and Earth") {
  for (const Look& look : looks()) {
    const Scene scene = read_scene_text(
        "title = \"Ring\"\nstructure.kind = \"hoop\"\nstructure.fold_angle = 85.0\nsolver.end_time = 10.0\n"
        "[render]\nlook = \"" +
            std::string(look.name) + "\"\nmethod = true\nerrors = true\naxes = true\nscale_bar = true\n",
        "ring.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    const Diagnostics diagnostics = diagnose(run);
    FrameStyle style = film_style(scene, run, diagnostics);
    style.width = 1280, style.height = 720;
    const DrawList list = FrameBuilder(run.trajectory, style).build(2.0);
    REQUIRE(list.labels.size() > 8);
    // The darkest and the brightest that is behind: shadow on the floor, the Earth's clouds.
    std::vector<Color> grounds = {list.background_top, list.background_bottom};
    if (list.ground.shown) grounds.push_back(over(list.ground.shadow, list.background_bottom));
    if (list.planet_half_angle > 0) grounds.push_back({0.75f, 0.80f, 0.88f, 1});
    // A swatch is a square in its colour within one of ink, which stands out from what is behind both.
    int swatches = 0;
    const auto within = [](const OverlayArea& in, const OverlayArea& out) {
      return out.x0 < in.x0 && in.x1 < out.x1 && out.y0 <= in.y0 && in.y1 <= out.y1;
    };
    for (std::size_t i = 0; i + 1 < list.areas.size(); ++i) {
      const OverlayArea &frame = list.areas[i], &square = list.areas[i + 1];
      if (!within(square, frame) || contrast(frame.color, look.ink) > 1) continue;
      ++swatches;
      Color backing{0, 0, 0, 0};
      if (i > 0 && within(frame, list.areas[i - 1])) backing = list.areas[i - 1].color;
      for (const Color& far : grounds) CHECK(contrast(frame.color, over(backing, far)) >= 3);
    }
    CHECK(swatches >= 2);
    for (const TextLabel& label : list.labels) {
      Color backing = label.backing;
      for (const OverlayArea& area : list.areas)
        if (label.x >= area.x0 && label.x <= area.x1 + 1 && label.y >= area.y0 && label.y < area.y1)
          backing = area.color;
      if (look.shading == Shading::outline || list.transparent) backing.a = std::max(backing.a, 0.0f);
      for (const Color& ground : grounds) {
        const Color behind = over(backing, ground);
        INFO(look.name << ": " << label.text);
        CHECK(contrast(label.color, behind) >= (is_sign(label) ? 3 : 4.5));
      }
    }
  }
}

}  // namespace contrast_test
