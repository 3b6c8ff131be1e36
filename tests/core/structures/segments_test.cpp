// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/segments.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "core/diagnostics/measures.hpp"
#include "core/structure/structure_error.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace segments_test {

namespace {

// Three rods in a row, all elastic, of unlike lengths and masses.
Structure row() {
  Structure s = testing::model_of(R"(
[structure]
kind = "custom"
section = "round"
youngs_modulus = 7e10
nodes = [{name = "O", position = [0.5, 0, 0], fixed = true},
         {name = "A", position = [1.7, 0, 0.9], velocity = [0, 0.6, 0], mass = 0.4},
         {name = "B", position = [1.7, 2, 0.9], velocity = [0.3, 0.6, 0], mass = 0.6},
         {name = "C", position = [4.7, 2, 0.9], velocity = [0.3, 1.5, -3], mass = 0.2}]
rods = [{nodes = ["O", "A"], mass = 1.2, area = 3e-5}, {nodes = ["A", "B"], mass = 0.9, area = 2e-5},
        {nodes = ["B", "C"], mass = 2.1, area = 1e-5}]
)")
                    ->structure;
  for (Rod& rod : s.rods) rod.free_length = 0.99 * rod.length, rod.multiplicity = 2;
  return s;
}

std::string refusal(Structure s, const std::vector<long>& segments) {
  try {
    cut_rods(s, segments);
  } catch (const StructureError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("rods are cut into equal parts that bend, and the others stay what they were") {
  const Structure whole = row();
  Structure cut = whole;
  cut_rods(cut, {3, 1, 2});
  const struct {
    const char* name;
    int a, b;
    std::size_t of;
    double share;
  } parts[] = {{"O-A.1", 0, 4, 0, 3}, {"O-A.2", 4, 5, 0, 3}, {"O-A.3", 5, 1, 0, 3},
               {"A-B", 1, 2, 1, 1},   {"B-C.1", 2, 6, 2, 2}, {"B-C.2", 6, 3, 2, 2}};
  REQUIRE(cut.rods.size() == 6);
  REQUIRE(cut.rod_copies.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    const Rod &part = cut.rods[i], &rod = whole.rods[parts[i].of];
    CAPTURE(i);
    CHECK(part.name == parts[i].name);
    CHECK(part.a == parts[i].a);
    CHECK(part.b == parts[i].b);
    CHECK(part.mass == Approx(rod.mass / parts[i].share));
    CHECK(part.length == Approx(rod.length / parts[i].share));
    CHECK(part.free_length == Approx(rod.free_length / parts[i].share));
    CHECK(part.area == rod.area);
    CHECK(part.second_moment == rod.second_moment);
    CHECK(part.multiplicity == 2);
    CHECK(part.parts == static_cast<int>(parts[i].share));
    CHECK(part.whole == (parts[i].share > 1 ? rod.name : ""));
    CHECK(part.pinned_length() == Approx(rod.natural_length()));
    const RodCopy& shown = cut.rod_copies[i];
    CHECK(shown.name == parts[i].name);
    CHECK(shown.a == parts[i].a);
    CHECK(shown.b == parts[i].b);
    CHECK(shown.source == static_cast<int>(i));
  }
  // Nodes between, with positions and velocities of their shares of the way, without a mass of their own.
  REQUIRE(cut.nodes.size() == 7);
  REQUIRE(cut.node_copies.size() == 7);
  const auto between = [&](std::size_t i, const char* name, std::size_t a, std::size_t b, double u) {
    const Node& node = cut.nodes[i];
    CHECK(node.name == name);
    CHECK((node.position - (1 - u) * whole.nodes[a].position - u * whole.nodes[b].position).norm() < 1e-15);
    CHECK((node.velocity - (1 - u) * whole.nodes[a].velocity - u * whole.nodes[b].velocity).norm() < 1e-15);
    CHECK(node.mass == 0);
    CHECK(cut.node_copies[i].name == name);
    CHECK(cut.node_copies[i].source == static_cast<int>(i));
    CHECK(cut.node_copies[i].map == Mat3::Identity());
    CHECK(cut.node_copies[i].offset.isZero(0.0));
  };
  between(4, "O-A.1", 0, 1, 1.0 / 3);
  between(5, "O-A.2", 0, 1, 2.0 / 3);
  between(6, "B-C.1", 2, 3, 0.5);
  const struct {
    const char* name;
    std::vector<int> nodes;
    std::size_t rod;
  } bends[] = {{"bending of O-A.1", {0, 4, 5}, 0},
               {"bending of O-A.2", {4, 5, 1}, 0},
               {"bending of B-C.1", {2, 6, 3}, 2}};
  REQUIRE(cut.forces.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(cut.forces[i].kind == "bending");
    CHECK(cut.forces[i].name == bends[i].name);
    CHECK(cut.forces[i].nodes == bends[i].nodes);
    // A round section of area A has the second moment A^2 / 4 pi; two of them side by side.
    const double area = whole.rods[bends[i].rod].area;
    CHECK(cut.forces[i].stiffness ==
          Approx(2 * 7e10 * area * area / (4 * 3.14159265358979323846)).epsilon(1e-12));
  }
}

TEST_CASE("what is not cut stays, and what cannot be cut is refused") {
  Structure same = row();
  cut_rods(same, {1, 1, 0});
  CHECK(same.rods.size() == 3);
  CHECK(same.nodes.size() == 4);
  CHECK(same.forces.empty());
  Structure rigid = row();
  rigid.rods[1].youngs_modulus = std::numeric_limits<double>::infinity();
  CHECK(refusal(rigid, {2, 1, 2}).empty());
  CHECK(refusal(rigid, {1, 2, 1}) == "rod A-B needs area and youngs_modulus to bend");
  Structure thin = row();
  thin.rods[0].second_moment = 0;
  CHECK(refusal(thin, {2, 1, 1}) == "rod O-A needs area and youngs_modulus to bend");
  Structure sector = row();
  sector.sectors = 5;
  const std::string whole = "a sector model cannot cut its rods; set structure.model to \"full\"";
  CHECK(refusal(sector, {1, 1, 2}) == whole);
  sector = row();
  sector.node_copies.pop_back();
  CHECK(refusal(sector, {1, 1, 2}) == whole);
}

// A column of 2 m, 1e-4 m^2, round, pressed with 250 N: Euler's load is pi^2 E A^2 / (4 pi l^2).
const std::string column = R"(
[structure]
kind = "custom"
youngs_modulus = 7e10
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [2, 0, 0]},
         {name = "C", position = [2, 0.7, 0], mass = 1}]
rods = [{nodes = ["A", "B"], density = 2700, area = 1e-4}, {nodes = ["B", "C"], density = 2700, area = 1e-4}]
[[constraints]]
kind = "line"
nodes = ["B"]
direction = [1, 0, 0]
[[loads]]
nodes = ["B"]
force = [-250, 0, 0]
[solver]
step = 1e-3
stages = 4
end_time = 2e-3
)";

TEST_CASE("a rod that is cut buckles at the load of the whole rod") {
  constexpr double pi = 3.14159265358979323846;
  const double euler = pi * pi * 7e10 * 1e-8 / (4 * pi) / 4;
  for (const char* segments : {"1", "4", "9"}) {
    const Simulation run = testing::run_scene(column, {std::string("structure.segments=") + segments});
    REQUIRE(run.status == RunStatus::completed);
    // At rest but for B-C, which nothing moves: 250 N to round-off.
    CHECK(find_measure("buckling_margin").value(run, diagnose(run)) == Approx(euler / 250 - 1).epsilon(1e-9));
  }
}

TEST_CASE("an error of length is that of a whole rod, however many parts it is cut into") {
  const auto wholes = [](const char* segments, const char* error) {
    const Structure s = build_structure(read_scene_text(
        column, "s.toml",
        {std::string("structure.segments=") + segments, std::string("structure.length_error=") + error}));
    std::vector<double> sums;
    for (std::size_t r = 0; r < s.rods.size(); ++r) {
      if (r == 0 || s.rods[r].whole.empty() || s.rods[r].whole != s.rods[r - 1].whole) sums.push_back(0);
      sums.back() += s.rods[r].length;
    }
    return sums;
  };
  const std::vector<double> once = wholes("1", "1e-3"), made = wholes("1", "0");
  REQUIRE(once.size() == 2);
  for (const char* segments : {"2", "4", "16"}) {
    const std::vector<double> parts = wholes(segments, "1e-3");
    REQUIRE(parts.size() == 2);
    for (std::size_t r = 0; r < 2; ++r) {
      CHECK(std::abs(once[r] - made[r]) > 1e-5);
      CHECK(parts[r] == Approx(once[r]).epsilon(1e-14));  // a sum of 16 of them
    }
  }
}

// Half as much again for each end that is held at an angle, wherever the rod begins: of its parts that next
// to the end, of two parts the one couple between them for both.
TEST_CASE("a rod that is held at an angle bends as stiffly whichever end it is given from") {
  const auto couples = [](const std::string& nodes, int parts, bool both) {
    const auto model = testing::model_of(R"([structure]
kind = "custom"
nodes = [{name = "W", position = [0, -1, 0], fixed = true}, {name = "O", position = [0, 0, 0], fixed = true},
         {name = "A", position = [1.2, 0, 0], mass = 0.4}, {name = "B", position = [1.2, 0.7, 0], mass = 1}]
rods = [{nodes = ["A", "B"], mass = 1},
        {area = 2e-4, youngs_modulus = 7e10, mass = 0.8, segments = )" +
                                         std::to_string(parts) + ", nodes = [" + nodes + R"(]}]
[[constraints]]
kind = "plane"
nodes = ["A", "B"]
normal = [0, 0, 1]
[[constraints]]
kind = "angle"
nodes = ["W", "O", "A"]
axis = [0, 0, 1]
)" + (both ? "[[constraints]]\nkind = 'angle'\nnodes = ['O', 'A', 'B']\naxis = [0, 0, 1]\n" : ""));
    std::vector<double> found;
    for (const Force& force : model->structure.forces)
      if (force.kind == "bending") found.push_back(force.stiffness);
    std::ranges::sort(found);
    const double least = found.front();
    for (double& x : found) x /= least;
    return found;
  };
  const auto is = [](const std::vector<double>& found, const std::vector<double>& wanted) {
    REQUIRE(found.size() == wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(wanted[i]));
  };
  for (const char* nodes : {"'O', 'A'", "'A', 'O'"}) {
    INFO(nodes);
    is(couples(nodes, 4, false), {1, 1, 1.5});
    is(couples(nodes, 4, true), {1, 1.5, 1.5});
    is(couples(nodes, 3, true), {1, 1});
  }
}

TEST_CASE("the name of a rod that was cut names all of its parts") {
  const auto warmed = [](const std::string& rods) {
    const Structure s = build_structure(read_scene_text(
        column +
            "[[forces]]\nkind = 'temperature'\nexpansion = 2e-5\nchange = 30\ntimes = [0, 1]\n"
            "values = [0, 1]\nrods = [" +
            rods + "]\n",
        "s.toml", {"structure.segments=3"}));
    std::string names;
    for (const Rod& rod : s.rods)
      if (rod.expansion != 0) names += rod.name + " ";
    return names;
  };
  CHECK(warmed("'A-B'") == "A-B.1 A-B.2 A-B.3 ");
  CHECK(warmed("'*-C'") == "B-C.1 B-C.2 B-C.3 ");
  CHECK(warmed("'A-B.2', 'B-C'") == "A-B.2 B-C.1 B-C.2 B-C.3 ");
  CHECK_THROWS_WITH(warmed("'A-D'"), Catch::Contains("no group 'A-D'; did you mean 'A-B'?"));
  // The angle between two rods is that of their tangents at the node that they share, through the first two
  // nodes within each.
  const Structure s = build_structure(
      read_scene_text(column + "[[forces]]\nkind = 'torsion_spring'\nstiffness = 5\nrods = ['A-B', 'B-C']\n",
                      "s.toml", {"structure.segments=3"}));
  const auto spring =
      std::ranges::find_if(s.forces, [](const Force& f) { return f.kind == "torsion_spring"; });
  REQUIRE(spring != s.forces.end());
  std::vector<std::string> at;
  for (const int node : spring->measure.nodes) at.push_back(s.nodes[static_cast<std::size_t>(node)].name);
  CHECK(at == std::vector<std::string>{"B", "A-B.2", "B", "B-C.1", "A-B.1", "B-C.2"});
}

}  // namespace segments_test

// Readers of tables take columns by name.
TEST_CASE("parts of a rod whose names the scene has already are refused") {
  const auto scene = [](const char* node, const char* rod) {
    return std::string(R"([structure]
kind = "custom"
youngs_modulus = 7e10
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1},
         {name = ")") +
           node + R"(", position = [3, 0, 0], mass = 5}]
rods = [{nodes = ["A", "B"], mass = 1, area = 1e-4, segments = 2}, {nodes = ["B", ")" +
           node + R"("], mass = 1, area = 1e-4, name = ")" + rod + R"("}]
)";
  };
  CHECK(testing::error_of(scene("C", "C-B")).empty());
  CHECK(testing::error_of(scene("A-B.2", "A-B.3")).empty());  // its nodes are A-B.1, its rods A-B.1, A-B.2
  CHECK_THAT(testing::error_of(scene("A-B.1", "C-B")),
             Catch::Contains("structure.segments: rod A-B is cut into parts") &&
                 Catch::Contains("A-B.1 is the name of a node already"));
  CHECK_THAT(testing::error_of(scene("C", "A-B.2")), Catch::Contains("A-B.2 is the name of a rod already"));
}

// Held at the middle of a beam by a relation or on its line, a node stays on the straight line that the bent
// rod leaves: whatever else the node has, and in whatever order it is written.
TEST_CASE("a rod that carries a pin between its ends is not cut") {
  const auto beam = [](const std::string& held, const char* segments) {
    return std::string(R"([structure]
kind = "custom"
youngs_modulus = 7e10
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [2, 0, 0], mass = 1},
         {name = "P", position = [1, 0, 0], mass = 5}, {name = "Q", position = [1, 0, -1], mass = 1}]
rods = [{nodes = ["A", "B"], density = 2700, area = 1e-4, segments = )") +
           segments + R"(}, {nodes = ["P", "Q"], density = 2700, area = 1e-4}]
[[constraints]]
)" + held;
  };
  const char* holds[] = {
      "kind = 'relation'\nnodes = ['A', 'B', 'P']\ncoefficients = [0, 0, 0.5, 0, 0, 0.5, 0, 0, -1]\n",
      "kind = 'relation'\nnodes = ['P', 'A', 'B']\ncoefficients = [0, 0, -1, 0, 0, 0.3, 0, 0, 0.7]\n",
      "kind = 'collinear'\nnodes = ['A', 'B', 'P']\n", "kind = 'collinear'\nnodes = ['P', 'A', 'B']\n"};
  for (const char* held : holds) {
    INFO(held);
    CHECK_THAT(testing::error_of(beam(held, "4")),
               Catch::Contains("rods that carry a pin between their ends (P) cannot be cut"));
    const auto model = testing::model_of(beam(held, "1"));
    bool said = false;
    for (const std::string& note : model->structure.notes)
      said = said || note.find("1 rod with pins between the ends") != std::string::npos;
    CHECK(said);
  }
  // A point without mass, and one of the ground that no rod leads to: beside the rod, or the anchor of a
  // hinge.
  const std::vector<std::string> massless{"structure.nodes.P.mass=0",
                                          "structure.rods=[{nodes=['A','B'],density=2700,"
                                          "area=1e-4,segments=4},{nodes=['B','Q'],density=2700,area=1e-4}]"};
  CHECK_THAT(testing::error_of(beam(holds[0], "4"), massless), Catch::Contains("cannot be cut"));
  const std::string anchor = "kind = 'fixed'\nnodes = ['P']\n";
  CHECK(testing::error_of(beam(anchor, "4"), massless).empty());
  // Places may be given in five digits.
  const std::vector<std::string> rounded{"structure.nodes.P.position=[1, 0, 3e-5]"};
  CHECK_THAT(testing::error_of(beam(holds[0], "4"), rounded), Catch::Contains("cannot be cut"));
  // A relation of one coordinate may tie what stands beside the rod.
  const std::string aside =
      "kind = 'relation'\nnodes = ['A', 'B', 'Q']\ncoefficients = [0.5, 0, 0, 0.5, 0, 0, -1, 0, 0]\n";
  CHECK(testing::error_of(beam(aside, "4")).empty());
  const auto beside = testing::model_of(beam(aside, "1"));
  for (const std::string& note : beside->structure.notes)
    CHECK(note.find("pins between the ends") == std::string::npos);
  // Beyond the end of a rod, in line with it, nothing is held between.
  CHECK(testing::error_of(beam("kind = 'collinear'\nnodes = ['A', 'P', 'B']\n", "1")).empty());
  CHECK(testing::error_of(R"([structure]
kind = "custom"
youngs_modulus = 7e10
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "P", position = [1, 0, 0], mass = 1},
         {name = "B", position = [2, 0, 0], mass = 1}]
rods = [{nodes = ["A", "P"], mass = 1, area = 1e-4, segments = 2}, {nodes = ["P", "B"], mass = 1, area = 1e-4}]
[[constraints]]
kind = "collinear"
nodes = ["A", "P", "B"]
)")
            .empty());
}
