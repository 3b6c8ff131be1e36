// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/image_scale.hpp"

#include <catch2/catch.hpp>

using namespace unfurl;

TEST_CASE("a smaller picture has the mean of what it covers") {
  const Image image{4, 2, {0, 0, 0, 255, 100, 0, 0, 255, 10, 20, 30, 255, 10, 20, 30, 255,
                           0, 0, 0, 255, 100, 0, 0, 255, 10, 20, 30, 255, 10, 20, 30, 255}};
  const Image half = scaled_down(image, 2, 1);
  CHECK(half.rgba == std::vector<std::uint8_t>{50, 0, 0, 255, 10, 20, 30, 255});
  // Three of four columns: the middle pixel takes a third of its width from each of columns 1 and 2.
  const Image odd = scaled_down(image, 3, 2);
  CHECK(odd.rgba[4] == 55);
  CHECK(scaled_down(image, 4, 2).rgba == image.rgba);
  CHECK_THROWS_AS(scaled_down(image, 8, 2), std::invalid_argument);
}

TEST_CASE("what is transparent lends a smaller picture no colour") {
  const Image image{2, 1, {200, 100, 50, 255, 9, 9, 9, 0}};
  CHECK(scaled_down(image, 1, 1).rgba == std::vector<std::uint8_t>{200, 100, 50, 128});
}

TEST_CASE("before a wall half a colour is half the wall's") {
  const Image picture{2, 1, {200, 100, 0, 255, 0, 0, 0, 51}};
  CHECK(before_wall(picture, {255, 255, 255}).rgba ==
        std::vector<std::uint8_t>{200, 100, 0, 255, 204, 204, 204, 255});
  CHECK(before_wall(picture, {0, 100, 255}).rgba ==
        std::vector<std::uint8_t>{200, 100, 0, 255, 0, 80, 204, 255});
}

TEST_CASE("pictures side by side keep their rows") {
  const Image a{1, 2, {1, 1, 1, 1, 2, 2, 2, 2}}, b{1, 2, {3, 3, 3, 3, 4, 4, 4, 4}};
  const Image both = side_by_side({a, b});
  CHECK(both.width == 2);
  CHECK(both.rgba == std::vector<std::uint8_t>{1, 1, 1, 1, 3, 3, 3, 3, 2, 2, 2, 2, 4, 4, 4, 4});
}
