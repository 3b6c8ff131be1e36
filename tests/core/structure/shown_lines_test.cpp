// SPDX-License-Identifier: BSD-3-Clause
// What is seen between nodes and is no rod: telescopes, actuators, cables, springs.
#include "core/structure/shown_lines.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace shown_lines_test {

TEST_CASE("stages of telescopes and driven lengths without a rod are lines between their nodes") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1},
  {name = "C", position = [2, 0, 0], mass = 1}, {name = "D", position = [3, 0, 0], mass = 1},
  {name = "E", position = [0, 1, 0], fixed = true}, {name = "F", position = [2, 1, 0], mass = 1}]
rods = [{nodes = ["C", "F"], mass = 1}]
[[constraints]]
kind = "telescope"
nodes = ["A", "B", "C", "D"]
[[constraints]]
kind = "length"
nodes = ["E", "B"]
[[constraints]]
kind = "length"
nodes = ["F", "C"]
motion = "hold"
[[forces]]
kind = "spring"
nodes = ["E", "F"]
stiffness = 10
)");
  // Not where a rod is: C-F has one.
  CHECK(telescopes(model->structure) == std::vector<std::vector<int>>{{0, 1, 2, 3}, {4, 1}});
  // What a stop holds is none of it.
  Structure met = model->structure;
  met.constraints.push_back(met.constraints.back());
  met.constraints.back().kind = "measure";
  met.constraints.back().measure = {MeasureKind::length, {4, 3}, Vec3::Zero(), 0.0, {}};
  CHECK(telescopes(met).size() == 3);
  met.constraints.back().of_stop = true;
  CHECK(telescopes(met) == telescopes(model->structure));
  std::string lines;
  for (const ShownLine& line : lines_between_nodes(model->structure))
    lines += line.group + " " + std::to_string(line.a) + std::to_string(line.b) + " ";
  CHECK(lines == "spring 45 actuator 01 actuator 12 actuator 23 actuator 41 ");
}

}  // namespace shown_lines_test
