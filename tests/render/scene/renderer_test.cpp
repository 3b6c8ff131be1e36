// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/renderer.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "render/gl/functions.hpp"
#include "render/image/image_scale.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace renderer_test {

namespace {

constexpr int width = 320, height = 180;

struct Pixel {
  int r, g, b;
  int sum() const { return r + g + b; }
};

Pixel at(const Image& image, float x, float y) {
  const auto i =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgba.at(i), image.rgba.at(i + 1), image.rgba.at(i + 2)};
}

// What shows at the place of a point in space.
Pixel at(const Image& image, const DrawList& list, const Vec3f& point) {
  const Vec3f pixel = project(list.camera, image.width, image.height, point);
  return at(image, pixel.x(), pixel.y());
}

// A floor without lines where we look, seen from above at an angle; the light comes straight from above.
DrawList empty_room() {
  DrawList list;
  list.camera.eye = {0, -8, 6};
  list.camera.target = {0, 0, 0.5f};
  list.camera.vertical_field_of_view = 0.6f;
  list.radius = 4;
  list.light_direction = {0, 0, 1};
  list.ground.cell = 100;  // its lines are far from where we look, but for those through the origin
  list.ground.fade = 30;
  list.background_top = {0.5f, 0.6f, 0.7f, 1};
  list.background_bottom = {0.9f, 0.9f, 0.9f, 1};
  return list;
}

const Tube red_tube{{-2, 0, 1}, {2, 0, 1}, 0.2f, {0.8f, 0.05f, 0.05f, 1}, Finish::paint};

struct Studio {
  std::unique_ptr<GlContext> context = make_offscreen_context();
  Renderer renderer{*context, width, height};
};

}  // namespace

TEST_CASE("without a floor the background is its gradient") {
  Studio studio;
  DrawList list = empty_room();
  list.ground.shown = false;
  const Image image = studio.renderer.draw(list);
  // Half a pixel from the edges the mix is 1/360 off the end colours: 8-bit rounding at most.
  const Pixel top = at(image, 10, 0), bottom = at(image, 310, height - 1);
  CHECK(top.r == Approx(0.5 * 255).margin(1.5));
  CHECK(top.b == Approx(0.7 * 255).margin(1.5));
  CHECK(bottom.r == Approx(0.9 * 255).margin(1.5));
  CHECK(gl::GetError() == GL_NO_ERROR);
}

TEST_CASE("a red tube across the picture is red, and only there") {
  Studio studio;
  DrawList list = empty_room();
  const Image without = studio.renderer.draw(list);
  list.tubes.push_back(red_tube);
  const Image image = studio.renderer.draw(list);
  for (const float x : {-1.9f, -1.0f, 0.0f, 1.0f, 1.9f}) {
    const Pixel p = at(image, list, {x, 0, 1});
    CHECK(p.r > 120);
    CHECK(p.r > 2 * p.g);
    CHECK(p.r > 2 * p.b);
  }
  const Pixel above = at(image, list, {0, 0, 1.6f}), before = at(without, list, {0, 0, 1.6f});
  CHECK(above.sum() == before.sum());
}

TEST_CASE("the tube's upper side is brighter than its lower side") {
  Studio studio;
  DrawList list = empty_room();
  list.camera.eye = {0, -8, 1};
  list.camera.target = {0, 0, 1};
  list.tubes.push_back(red_tube);
  const Image image = studio.renderer.draw(list);
  CHECK(at(image, list, {0.5f, -0.15f, 1.13f}).sum() > at(image, list, {0.5f, -0.15f, 0.87f}).sum() + 60);
}

TEST_CASE("the floor is darker in the tube's shadow than beside it") {
  Studio studio;
  DrawList list = empty_room();
  const Image lit = studio.renderer.draw(list);
  list.tubes.push_back(red_tube);
  const Image image = studio.renderer.draw(list);
  for (const float x : {-1.5f, 0.7f, 1.5f}) {
    const Vec3f below(x, 0.1f, 0), beside(x, -1.0f, 0);
    CHECK(at(image, list, below).sum() < at(lit, list, below).sum() - 60);
    CHECK(at(image, list, beside).sum() == at(lit, list, beside).sum());
  }
}

TEST_CASE("a body in another's shadow is darker") {
  Studio studio;
  DrawList list = empty_room();
  list.balls.push_back({{0, 0, 0.5f}, 0.4f, {0.7f, 0.7f, 0.7f, 1}, Finish::paint});
  const Vec3f probe(0, -0.15f, 0.85f);
  const Pixel lit = at(studio.renderer.draw(list), list, probe);
  list.tubes.push_back({{-2, 0, 2.5f}, {2, 0, 2.5f}, 0.5f, {0.7f, 0.7f, 0.7f, 1}});
  const Pixel shaded = at(studio.renderer.draw(list), list, probe);
  CHECK(shaded.sum() < lit.sum() - 60);
}

TEST_CASE("nearer bodies cover farther ones, whatever their kind and order") {
  Studio studio;
  DrawList list = empty_room();
  const Color blue{0.05f, 0.1f, 0.8f, 1};
  list.balls.push_back({{0, 2, 1}, 0.6f, blue, Finish::paint});
  list.sleeves.push_back({{-1, -2, 1}, {1, -2, 1}, 0.3f, red_tube.color, Finish::paint});
  const Image image = studio.renderer.draw(list);
  CHECK(at(image, list, {0, -2, 1}).r > 2 * at(image, list, {0, -2, 1}).b);
  CHECK(at(image, list, {0, 2, 1.3f}).b > 2 * at(image, list, {0, 2, 1.3f}).r);
}

TEST_CASE("grid lines lie on whole cells and fade with distance") {
  Studio studio;
  DrawList list = empty_room();
  const Image plain = studio.renderer.draw(list);
  list.ground.cell = 1;
  const Image image = studio.renderer.draw(list);
  const Vec3f on_line(1, -0.5f, 0), in_cell(1.5f, -0.5f, 0);
  CHECK(at(image, list, on_line).sum() < at(plain, list, on_line).sum() - 15);
  CHECK(at(image, list, in_cell).sum() == at(plain, list, in_cell).sum());
  list.ground.fade = 1;
  const Image faded = studio.renderer.draw(list);
  CHECK(at(faded, list, on_line).sum() == at(plain, list, on_line).sum());
}

TEST_CASE("edges are anti-aliased") {
  Studio studio;
  DrawList list = empty_room();
  list.ground.shown = false;
  list.background_top = list.background_bottom = {1, 1, 1, 1};
  list.tubes.push_back({{-2, 0, 0.9f}, {2, 0, 1.1f}, 0.2f, {0.0f, 0.0f, 0.0f, 1}, Finish::paint});
  const Image image = studio.renderer.draw(list);
  int between = 0;  // a slope of 1:20 crosses pixel rows; hard edges would jump from white to dark
  for (int x = 100; x < 220; ++x) {
    for (int y = 0; y < height; ++y) {
      const int value = at(image, static_cast<float>(x), static_cast<float>(y)).sum();
      between += value > 400 && value < 740;
    }
  }
  CHECK(between >= 60);
}

// What is thin is drawn as one flat ribbon: it has to look as the round body does, which is drawn with facets
// in a picture four times as large.
TEST_CASE("thin bodies look as their enlargements do, scaled down") {
  Studio studio;
  Renderer large(*studio.context, 4 * width, 4 * height);
  const Color red{0.8f, 0.2f, 0.1f, 1}, blue{0.2f, 0.4f, 0.8f, 1};
  DrawList list = empty_room();
  list.ground.shown = false;
  const Image background = studio.renderer.draw(list);
  const auto check = [&](const DrawList& seen) {
    const Image thin = studio.renderer.draw(seen), round = scaled_down(large.draw(seen), width, height);
    double sum = 0, there = 0;
    for (std::size_t i = 0; i < thin.rgba.size(); ++i) {
      if (std::abs(round.rgba[i] - background.rgba[i]) < 6) continue;
      sum += std::abs(thin.rgba[i] - round.rgba[i]);
      ++there;
    }
    CHECK(there > 300);
    // With four samples a pixel at an edge has up to an eighth of a contrast of some 200 too much or too
    // little, half of that in the mean, and about half of the pixels are at edges: 6. The rest is light.
    CHECK(sum / there < 9);
  };
  for (const Vec3f& along : {Vec3f(2, 0.3f, 0.4f), Vec3f(0.9f, 0.1f, 1), Vec3f(0.3f, 2, 0.1f)}) {
    const Vec3f middle(0, 0, 0.5f), side = along.cross(Vec3f(0.2f, 0.5f, 1)).normalized();
    DrawList rod = list, plate = list;
    rod.tubes.push_back({middle - along, middle + along, 0.055f, red, Finish::anodised});
    rod.sleeves.push_back({middle, middle + 0.3f * along, 0.07f, blue, Finish::metal});
    check(rod);
    plate.plates.push_back({middle - along, middle + along, side, 0.07f, 0.03f, blue, Finish::metal});
    check(plate);
  }
}

TEST_CASE("what is thinner than a pixel is a line without gaps") {
  Studio studio;
  DrawList list = empty_room();
  list.ground.shown = false;
  const Image without = studio.renderer.draw(list);
  const Vec3f middle(0, 0, 0.5f), along(0.05f, 0.02f, 1.1f);  // upright, slanted a little
  list.tubes.push_back({middle - along, middle + along, 0.001f, {0.1f, 0.1f, 0.1f, 1}, Finish::anodised});
  const Image with = studio.renderer.draw(list);
  int first = height, last = 0;
  std::vector<int> ink(height);  // of each row: how much darker it is
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const auto change = static_cast<int>(at(without, fx, fy).sum() - at(with, fx, fy).sum());
      if (change > 12) first = std::min(first, y), last = std::max(last, y);
      ink[static_cast<std::size_t>(y)] += std::max(change, 0);
    }
  REQUIRE(last - first > height / 4);
  int least = 1 << 30, most = 0;
  for (int y = first + 1; y < last; ++y) {
    least = std::min(least, ink[static_cast<std::size_t>(y)]);
    most = std::max(most, ink[static_cast<std::size_t>(y)]);
  }
  // A line of one pixel covers two to six of the samples that it meets in a row.
  CHECK(least * 4 > most);
}

TEST_CASE("labels are drawn over the picture") {
  Studio studio;
  DrawList list = empty_room();
  const Image before = studio.renderer.draw(list);
  list.labels.push_back({20, 10, 16, {0, 0, 0, 1}, "Ring"});
  const Image after = studio.renderer.draw(list);
  int changed_inside = 0, changed_outside = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const bool inside = x >= 20 && x < 70 && y >= 10 && y < 30;
      (inside ? changed_inside : changed_outside) += at(before, fx, fy).sum() != at(after, fx, fy).sum();
    }
  }
  CHECK(changed_inside > 60);
  CHECK(changed_outside == 0);
}

TEST_CASE("rods are dimmer where they meet others than half way between") {
  Studio studio;
  DrawList list = empty_room();
  list.ground.shown = false;
  list.tubes.push_back(red_tube);  // 20 radii long
  const Image image = studio.renderer.draw(list);
  // Below the middle line, where the key light does not reach and what lights it is the room.
  const float z = 1 - 0.8f * red_tube.radius;
  CHECK(at(image, list, {-1.8f, -0.1f, z}).sum() < at(image, list, {0, -0.1f, z}).sum() - 15);
  CHECK(at(image, list, {1.8f, -0.1f, z}).sum() < at(image, list, {0, -0.1f, z}).sum() - 15);
}

TEST_CASE("what is drawn once is drawn again when the camera, the floor or the colours change") {
  Studio studio;
  DrawList list = empty_room();
  list.ground.cell = 1;
  list.tubes.push_back(red_tube);
  std::vector<DrawList> lists(7, list);
  lists[1].camera.eye.x() += 1;
  lists[2].ground.z -= 0.5f;
  lists[3].ground.grid = false;
  lists[4].background_top = {1, 1, 1, 1};
  lists[5].transparent = true;
  lists[6].light_direction = {1, 0, 1};
  for (std::size_t k = 0; k < lists.size(); ++k) {
    CAPTURE(k);
    studio.context->make_current();
    studio.renderer.draw(list);
    const Image after = studio.renderer.draw(lists[k]);
    Studio fresh;
    const bool same = fresh.renderer.draw(lists[k]).rgba == after.rgba;
    CHECK(same);
  }
  studio.context->make_current();
}

// A body behind the camera has all of the picture drawn with several samples; it does not show.
TEST_CASE("the part of the picture that bodies are drawn in holds all of them") {
  Studio studio;
  for (const float parallel : {0.0f, 6.0f})
    for (int k = 0; k < 12; ++k) {
      DrawList list = empty_room();
      list.camera.parallel_height = parallel;
      const auto spread = [&](int n) { return static_cast<float>(7 * (k + 1) * n % 11) / 2.0f - 2.5f; };
      list.tubes.push_back({{spread(1), spread(2), 1 + spread(3)},
                            {spread(4), spread(5), 1},
                            0.1f + 0.05f * static_cast<float>(k),
                            red_tube.color});
      const Image part = studio.renderer.draw(list);
      list.ghosts.push_back({{0, -20, 12}, {0, -21, 12}, 0.01f, {0, 0, 0, 0}});
      const bool same = studio.renderer.draw(list).rgba == part.rgba;
      CHECK(same);
    }
}

TEST_CASE("the same list gives the same bytes, also after another picture and in another context") {
  DrawList list = empty_room();
  list.tubes.push_back(red_tube);
  list.arrows.push_back({{0, 0, 1}, {0, 0, 2}, 0.05f, {0, 0, 1, 1}});
  list.labels.push_back({20, 10, 16, {0, 0, 0, 1}, "Ring"});
  Studio studio;
  const Image first = studio.renderer.draw(list);
  studio.renderer.draw(empty_room());
  CHECK(studio.renderer.draw(list).rgba == first.rgba);
  Studio other;
  CHECK(other.renderer.draw(list).rgba == first.rgba);
  studio.context->make_current();  // it goes last, and needs its context
}

}  // namespace renderer_test
