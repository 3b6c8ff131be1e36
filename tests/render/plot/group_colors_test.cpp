// SPDX-License-Identifier: BSD-3-Clause
// A group of rods has one colour in pictures and in figures.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "render/plot/figures/rod_groups.hpp"
#include "render/plot/style.hpp"
#include "render/scene/appearance.hpp"
#include "render/scene/look.hpp"

using namespace unfurl;

namespace group_colors_test {

namespace {

double apart(const Color& a, const FigureColor& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

}  // namespace

// A contrast of 3 on white asks a fiftieth of the light of orange and of sky blue; no group comes so near to
// another one's colour.
TEST_CASE("a group of rods has the colour in figures that pictures on a pale ground give it") {
  int several = 0;
  for (const char* kind :
       {"hoop", "scissor_mast", "scissor_ring", "hoberman", "bricard", "cable_ring", "pendulum"}) {
    const auto model =
        build_model(read_scene_text("structure.kind = '" + std::string(kind) + "'\n", "s.toml"));
    const Appearance looks = appearance_of(model->structure, 1);
    const std::vector<RodGroup> groups = rod_groups(model->structure);
    several += looks.groups.size() > 1;
    for (const char* ground : {"studio", "print", "blueprint"})
      for (std::size_t i = 0; i < looks.groups.size(); ++i) {
        INFO(kind << ", " << ground << ": " << looks.groups[i]);
        const std::string shown = looks.groups[i].empty() ? "rod" : looks.groups[i];
        const auto group = std::ranges::find(groups, shown, &RodGroup::name);
        REQUIRE(group != groups.end());
        CHECK(apart(find_look(ground)->group(i), palette(group->color)) <= 0.02);
      }
  }
  CHECK(several >= 3);
}

TEST_CASE("colours of groups stand out from white, and the first eighteen are different ones") {
  for (int i = 0; i < 18; ++i) {
    const FigureColor a = palette(first_group_color + i);
    CAPTURE(i);
    CHECK(plot::contrast_on_white(a) >= 3);  // WCAG 2.1, 1.4.11
    for (int j = 0; j < i; ++j) {
      const FigureColor b = palette(first_group_color + j);
      CHECK(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}) > 0.04f);
    }
  }
}

}  // namespace group_colors_test
