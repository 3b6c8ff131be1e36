// SPDX-License-Identifier: BSD-3-Clause
// A group of rods has one colour in pictures and in figures.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "render/plot/figures.hpp"
#include "render/plot/figures/rod_groups.hpp"
#include "render/plot/style.hpp"
#include "render/scene/appearance.hpp"
#include "render/scene/look.hpp"
#include "tests/support/scene_run.hpp"

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
    CHECK(groups.size() == looks.groups.size());
    for (const char* ground : {"studio", "print", "blueprint"})
      for (std::size_t i = 0; i < looks.groups.size(); ++i) {
        INFO(kind << ", " << ground << ": " << looks.groups[i]);
        const auto group = std::ranges::find(groups, looks.groups[i], &RodGroup::name);
        REQUIRE(group != groups.end());
        CHECK(apart(find_look(ground)->group(i), palette(group->color)) <= 0.02);
      }
  }
  CHECK(several >= 3);
}

TEST_CASE("the figure of poses names the groups of rods that it draws", "[figures]") {
  const std::string poses = "solver.step = 0.01\nsolver.end_time = 0.05\nstructure.kind = ";
  using Names = std::vector<std::string>;
  const auto named = [&](const char* kind) {
    const Simulation run = testing::run_scene(poses + kind);
    Names names;
    const Figure figure = find_figure("poses")->make(run, diagnose(run));
    for (const Curve& curve : figure.panels.front().curves) names.push_back(curve.label);
    return names;
  };
  // Their braces are what makes bodies of rods, and not shown.
  CHECK(named("'hoberman'\n") == Names{"left element", "right element"});
  CHECK(named("'bricard'\n") == Names{"bar", "hinge pin"});
}

// As a list of rods in a CSV file has it with an empty cell.
TEST_CASE("rods whose group is an empty text are of the group that rods without one are of") {
  const auto model = testing::model_of(
      "structure.kind = 'custom'\nstructure.nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
      "{name = 'B', position = [1, 0, 0]}, {name = 'C', position = [2, 0, 0]}, {name = 'D', position = [3, "
      "0, 0]}]\nstructure.rods = [{nodes = ['A', 'B'], mass = 1, group = ''}, {nodes = ['B', 'C'], mass = 1, "
      "group = ''}, {nodes = ['C', 'D'], mass = 1}]\n");
  const std::vector<RodGroup> groups = rod_groups(model->structure);
  REQUIRE(groups.size() == 1);
  CHECK(groups[0].name == "rod");
  CHECK(groups[0].rods == std::vector<int>{0, 1, 2});
  CHECK(appearance_of(model->structure, 1).groups == std::vector<std::string>{"rod"});
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
