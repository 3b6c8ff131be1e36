// SPDX-License-Identifier: BSD-3-Clause
// What tells the looks apart, probed at known places.
#include "render/scene/look.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/render_options.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/still.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace look_test {

namespace {

constexpr int width = 320, height = 180;

struct Studio {
  std::unique_ptr<GlContext> context = make_offscreen_context();
  Renderer renderer{*context, width, height};
};

// A camera in front of the xz plane; 18 pixels are a metre, and a tube of 0.5 m is 18 pixels thick.
DrawList in_front(const Look& look) {
  DrawList list;
  list.camera.eye = {0, -20, 0};
  list.camera.target = {0, 0, 0};
  list.camera.parallel_height = 10;
  list.radius = list.framed_radius = 8;
  list.ground.shown = false;
  list.shading = look.shading;
  list.background_top = look.background_top;
  list.background_bottom = look.background_bottom;
  list.transparent = look.transparent;
  list.hidden_gap = 0.8f;
  list.light_direction = {-0.3f, -1, 0.5f};
  return list;
}

struct Pixel {
  int r, g, b, a;
  int sum() const { return r + g + b; }
};

Pixel at(const Image& image, float x, float z) {
  const Vec3f p = project(in_front(looks()[0]).camera, width, height, {x, 0, z});
  const auto i = 4 * (static_cast<std::size_t>(p.y()) * width + static_cast<std::size_t>(p.x()));
  return {image.rgba.at(i), image.rgba.at(i + 1), image.rgba.at(i + 2), image.rgba.at(i + 3)};
}

const Tube far_tube{{-6, 3, 0}, {6, 3, 0}, 0.5f, {0.0f, 0.37f, 0.66f, 1}},
    near_tube{{0, -3, -3}, {0, -3, 3}, 0.5f, {0.0f, 0.37f, 0.66f, 1}};

}  // namespace

TEST_CASE("the looks are those that the scene's key names") {
  const auto& params = render_params();
  const auto key = std::ranges::find(params, "look", &ParamSpec::name);
  REQUIRE(key != params.end());
  std::vector<std::string_view> names;
  for (const Look& look : looks()) names.push_back(look.name);
  CHECK(names == key->choices);
  CHECK(find_look("studyo") == nullptr);
}

TEST_CASE("a blueprint has dark lines along a tube, paper inside, and pale lines where it is hidden") {
  Studio studio;
  DrawList list = in_front(*find_look("blueprint"));
  list.tubes = {far_tube, near_tube};
  const Image image = studio.renderer.draw(list);
  CHECK(at(image, -3, 2).sum() == 3 * 255);         // paper
  CHECK(at(image, -3, 0).sum() > 3 * 230);          // inside the far tube
  const int line = at(image, -3, 0.47f).sum();      // its upper line, half a pixel from its side
  CHECK(line < 480);                                // up to half of that pixel lies beside the tube
  const int hidden = at(image, 0.1f, 0.47f).sum();  // the same line behind the near tube
  CHECK(hidden > line + 90);
  CHECK(hidden < at(image, 0.1f, 1.5f).sum() - 60);  // and yet to be seen
  list.tubes = {near_tube};
  CHECK(at(studio.renderer.draw(list), 0.1f, 0.47f).sum() > hidden + 60);
}

TEST_CASE("printed colours are the given ones on the lit side, on nothing") {
  Studio studio;
  DrawList list = in_front(*find_look("print"));
  list.tubes = {far_tube};
  const Image image = studio.renderer.draw(list);
  const Pixel lit = at(image, -3, 0.1f);
  // Decoded and encoded again with one power: 8-bit rounding.
  CHECK(lit.r == Approx(0).margin(2));
  CHECK(lit.g == Approx(0.37 * 255).margin(2));
  CHECK(lit.b == Approx(0.66 * 255).margin(2));
  CHECK(lit.a == 255);
  CHECK(at(image, -3, 3).a == 0);
}

TEST_CASE("edges before nothing keep their colour and are half transparent") {
  Studio studio;
  DrawList list = in_front(*find_look("print"));
  list.tubes = {far_tube};
  list.tubes[0].a.z() = -0.4f, list.tubes[0].b.z() = 0.4f;  // a slope crosses pixel rows
  const Image image = studio.renderer.draw(list);
  int partly = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    if (image.rgba[i + 3] < 40 || image.rgba[i + 3] > 215) continue;
    ++partly;
    CHECK(image.rgba[i + 2] > image.rgba[i] + 40);  // still blue: neither white nor black is mixed in
  }
  CHECK(partly > 200);
}

TEST_CASE("space is dark, with stars where they are asked for, and lit bodies in it") {
  Studio studio;
  const Look& look = *find_look("space");
  DrawList list = in_front(look);
  list.tubes = {far_tube};
  const auto brightest = [](const Image& image) {
    int most = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) most = std::max<int>(most, image.rgba[i]);
    return most;
  };
  const Image lit = studio.renderer.draw(list);
  CHECK(at(lit, -6, 4).sum() < 90);
  CHECK(at(lit, -3, 0.2f).b > 120);
  list.tubes.clear();
  CHECK(brightest(studio.renderer.draw(list)) < 40);
  list.stars = look.stars;
  CHECK(brightest(studio.renderer.draw(list)) > 100);
}

TEST_CASE("a transparent studio has shadows as transparent as they are light, and grid lines") {
  Studio studio;
  DrawList list = in_front(*find_look("studio"));
  list.transparent = true;
  list.camera.eye = {0, -15, 12};
  list.ground.shown = true;
  list.ground.z = -2;
  list.ground.cell = 100;
  list.ground.fade = 60;
  list.light_direction = {0, 0, 1};
  list.tubes = {{{-4, 0, 0}, {4, 0, 0}, 0.5f, {0.8f, 0.1f, 0.1f, 1}}};
  const Image image = studio.renderer.draw(list);
  const auto alpha = [&](const Vec3f& p) {
    const Vec3f pixel = project(list.camera, width, height, p);
    return image.rgba.at(
        4 * (static_cast<std::size_t>(pixel.y()) * width + static_cast<std::size_t>(pixel.x())) + 3);
  };
  CHECK(alpha({2, 0, 0}) == 255);
  CHECK(alpha({2, 0, -2}) > 60);  // in the shadow
  CHECK(alpha({2, 0, -2}) < 200);
  CHECK(alpha({2, -4, -2}) == 0);  // beside it
}

TEST_CASE("what is far is mistier than what is near, and only where it is asked for") {
  Studio studio;
  DrawList list = in_front(*find_look("print"));
  list.tubes = {{{-3, 6, 2}, {3, 6, 2}, 0.5f, {0, 0, 0, 1}}, {{-3, -6, -2}, {3, -6, -2}, 0.5f, {0, 0, 0, 1}}};
  const Image plain = studio.renderer.draw(list);
  CHECK(at(plain, 0, 2.1f).sum() == at(plain, 0, -1.9f).sum());
  list.depth_fade = 0.5f;
  const Image misty = studio.renderer.draw(list);
  CHECK(at(misty, 0, 2.1f).sum() > at(misty, 0, -1.9f).sum() + 150);
}

TEST_CASE("a ghost lets through what its colour says") {
  Studio studio;
  DrawList list = in_front(*find_look("print"));
  list.transparent = false;
  list.ghosts = {far_tube, far_tube};
  for (Tube& ghost : list.ghosts) ghost.color = {0, 0, 0, 0.3f};
  const Image image = studio.renderer.draw(list);
  // 30 % of black on white: 0.7 * 255, and the second ghost at the same place adds nothing but its seam.
  CHECK(at(image, -3, 0.1f).r == Approx(0.7 * 255).margin(90));
  CHECK(at(image, -3, 0.1f).r > 80);
  CHECK(at(image, -3, 2).r == 255);
}

TEST_CASE("transparent pictures without their transparency stand before what their texts can be read on") {
  for (const Look& look : looks()) {
    RenderOptions options;
    options.look = look.name;
    const Image wall = without_alpha({1, 1, {0, 0, 0, 0}}, options);
    CHECK(wall.rgba[3] == 255);
    CAPTURE(look.name);
    // Half of all there is from black to white, at least.
    CHECK(std::abs(static_cast<double>(look.ink.g) - wall.rgba[1] / 255.0) > 0.5);
  }
}

}  // namespace look_test
