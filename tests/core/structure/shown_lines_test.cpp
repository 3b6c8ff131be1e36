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

// Two telescopes that are not each other's stages, and lines to the first node; what has no copy is not seen.
TEST_CASE("telescopes go on from their own last stage and lines lead to the first node as well") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], mass = 2}, {name = "B", position = [1, 0, 0], mass = 1},
  {name = "C", position = [2, 0, 0], mass = 1}, {name = "D", position = [3, 0, 0], mass = 1},
  {name = "E", position = [0, 1, 0], fixed = true}, {name = "F", position = [0.8, 1.4, 0], mass = 1},
  {name = "G", position = [1.6, 1.8, 0], mass = 1}, {name = "H", position = [2.8, 2.4, 0], mass = 1}]
[[constraints]]
kind = "telescope"
nodes = ["D", "C", "B"]
[[constraints]]
kind = "telescope"
nodes = ["E", "F", "G", "H"]
[[forces]]
kind = "spring"
nodes = ["E", "A"]
stiffness = 10
[[forces]]
kind = "cable"
nodes = ["H", "D"]
axial_stiffness = 1e3
[[forces]]
kind = "cable"
nodes = ["C", "A"]
axial_stiffness = 1e3
)");
  Structure structure = model->structure;
  CHECK(telescopes(structure) == std::vector<std::vector<int>>{{3, 2, 1}, {4, 5, 6, 7}});
  const auto listed = [&] {
    show_cables(structure);
    std::string lines;
    for (const ShownLine& line : lines_between_nodes(structure))
      lines += line.group + " " + std::to_string(line.a) + std::to_string(line.b) + " ";
    return lines;
  };
  CHECK(listed() ==
        "cable 73 cable 20 spring 40 actuator 32 actuator 21 actuator 45 actuator 56 actuator 67 ");
  // A second copy of a node is not what lines lead to, and H is not shown at all.
  structure.node_copies.back() = structure.node_copies[2];
  CHECK(listed() == "cable 20 spring 40 actuator 32 actuator 21 actuator 45 actuator 56 ");
  CHECK(stretches({MeasureKind::length, {5, 3}, Vec3::Zero(), 0.0, {}}) ==
        std::vector<std::pair<int, int>>{{5, 3}});
}

// Four tenths of the thinnest: 0.004 of the size, a rod's own radius, or a sixtieth of the length of one that
// has none.
TEST_CASE("lines are thinner than the thinnest rod") {
  const auto model = testing::model_of(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', "
      "position = [1.2, 0, 0]}, {name = 'C', position = [1.2, 3, 0]}]\nrods = [{nodes = ['A', 'B'], mass = "
      "1}, "
      "{nodes = ['B', 'C'], mass = 1}]\n");
  const auto radius = [&](double first, double second, double size) {
    Structure structure = model->structure;
    structure.rods[0].radius = first, structure.rods[1].radius = second;
    return shown_line_radius(structure, size);
  };
  CHECK(radius(0, 0, 100) == Approx(0.4 * 1.2 / 60));
  CHECK(radius(0, 0, 2) == Approx(0.4 * 0.008));
  CHECK(radius(0, 0, 0) == Approx(0.4 * 0.004));
  CHECK(radius(0.07, 0.03, 100) == Approx(0.4 * 0.03));
  CHECK(radius(0.07, 0.3, 100) == Approx(0.4 * 0.07));
}

// A cable that takes its pull up over a length, as those of nets do, is drawn as a net's.
TEST_CASE("cables and the cords of nets are lines of a group each") {
  const auto model = testing::model_of(R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1},
  {name = "C", position = [2, 0, 0], mass = 1}]
[[forces]]
kind = "cable"
nodes = ["A", "B"]
axial_stiffness = 10
[[forces]]
kind = "cable"
nodes = ["B", "C"]
axial_stiffness = 10
smoothing = 0.01
)");
  std::string lines;
  for (const ShownLine& line : model->structure.lines)
    lines += line.group + " " + std::to_string(line.a) + std::to_string(line.b) + " ";
  CHECK(lines == "cable 01 net 12 ");
}

}  // namespace shown_lines_test
