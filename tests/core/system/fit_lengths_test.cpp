// SPDX-License-Identifier: BSD-3-Clause
// Given rod lengths that do not fit the node positions: assembled where they nearly do, refused by name
// where not.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/structure/structure_error.hpp"
#include "tests/support/number.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace fit_lengths_test {

namespace {

// A four-bar linkage on the ground pins O and Q; its bars get the lengths named.
std::string four_bar(const std::string& left, const std::string& top, const std::string& right,
                     const std::string& more = "") {
  const auto rod = [](const char* nodes, const std::string& length) {
    return "[[structure.rods]]\nnodes = " + std::string(nodes) + "\nmass = 1\n" +
           (length.empty() ? "" : "length = " + length + "\n");
  };
  const auto node = [](const char* name, const char* position, bool fixed) {
    return "[[structure.nodes]]\nname = \"" + std::string(name) + "\"\nposition = " + position +
           (fixed ? "\nfixed = true\n" : "\n");
  };
  return "title = \"four bar\"\n[structure]\nkind = \"custom\"\n" + node("O", "[0, 0, 0]", true) +
         node("Q", "[2, 0, 0]", true) + node("A", "[0, 1, 0]", false) + node("B", "[2, 1, 0]", false) +
         rod("[\"O\", \"A\"]", left) + rod("[\"A\", \"B\"]", top) + rod("[\"Q\", \"B\"]", right) + more +
         "[[structure.constraints]]\nkind = \"plane\"\nnodes = [\"A\", \"B\"]\nnormal = [0, 0, 1]\n"
         "[solver]\nend_time = 0.5\n[gravity]\nacceleration = [1, -9.81, 0]\n";
}

using testing::error_of, testing::model_of;

}  // namespace

TEST_CASE("rods get lengths that nearly fit, and a note says how far nodes moved") {
  const auto model = model_of(four_bar("1.004", "1.995", "1.001"));
  for (const Rod& rod : model->structure.rods) {
    const Vec3 d = model->structure.nodes[static_cast<std::size_t>(rod.b)].position -
                   model->structure.nodes[static_cast<std::size_t>(rod.a)].position;
    CHECK(d.norm() == Approx(rod.length).epsilon(1e-13));  // round-off of the coordinates
  }
  CHECK(model->structure.rods[0].length == 1.004);
  CHECK(model->structure.nodes[0].position == Vec3(0, 0, 0));
  const Simulation run = simulate(model, {.end_time = 0.5});
  CHECK(run.status == RunStatus::completed);
  REQUIRE_FALSE(run.warnings.empty());
  CHECK(run.warnings[0].find("nodes were moved to fit") != std::string::npos);
  CHECK(run.warnings[0].find("O-A") != std::string::npos);
}

TEST_CASE("lengths that fit move nothing and say nothing") {
  const auto model = model_of(four_bar("1", "", "1"));
  CHECK(model->structure.notes.empty());
  CHECK(model->structure.nodes[2].position == Vec3(0, 1, 0));
}

TEST_CASE("a length that is far off is refused with rod, length, distance and cure") {
  const std::string text = error_of(four_bar("1.2", "", ""));
  for (const char* part : {"s.toml:", "rods[0].length", "rod O-A is given a length of 1.2 m",
                           "O and A are 1 m apart", "leave the length out"})
    CHECK_THAT(text, Catch::Contains(part));
}

TEST_CASE("a length of a rod that is cut to bend is told as it was given") {
  const std::string elastic = GENERATE("false", "true");
  const std::string text = error_of(
      "[structure]\nkind = \"custom\"\n"
      "nodes = [{name = \"A\", position = [0, 0, 0]}, {name = \"B\", position = [1, 0, 0]}, "
      "{name = \"C\", position = [3, 0, 0]}]\n"
      "constraints = [{kind = \"fixed\", nodes = [\"A\"]}]\n"
      "[[structure.rods]]\nnodes = [\"A\", \"B\"]\ndensity = 2700\narea = 1e-4\nyoungs_modulus = 7e10\n"
      "second_moment = 1e-9\nsegments = 4\n"
      "[[structure.rods]]\nnodes = [\"B\", \"C\"]\ndensity = 2700\narea = 1e-4\nyoungs_modulus = 7e10\n"
      "second_moment = 1e-9\nsegments = 4\nlength = 2.5\nelastic = " +
      elastic + "\n");
  CHECK_THAT(text, Catch::Contains("structure.rods[1].length: "));
  CHECK_THAT(text, Catch::Contains("rod B-C "));
  CHECK_THAT(
      text, Catch::Contains(elastic == "true" ? "20 %" : "a length of 2.5 m, but its nodes B and C are 2 m"));
}

TEST_CASE("lengths without a pose are refused by name") {
  // With the brace O-B the frame is rigid but for nothing: another brace from Q must have the length sqrt(5).
  const auto brace = [](const char* nodes, const char* length) {
    return "[[structure.rods]]\nnodes = " + std::string(nodes) + "\nmass = 1\nlength = " + length + "\n";
  };
  const std::string text = error_of(four_bar(
      "1", "2", "1", brace("[\"O\", \"B\"]", "2.2360679774997896") + brace("[\"Q\", \"A\"]", "2.25")));
  CHECK_THAT(text, Catch::Contains("rod Q-A is given a length of 2.25 m"));
  CHECK_THAT(text, Catch::Contains("no pose close to the given one"));
}

TEST_CASE("what cannot move, or is driven against what holds it, is refused by name") {
  const std::string stiff =
      error_of(four_bar("", "", "", "[[structure.rods]]\nnodes = [\"O\", \"B\"]\nmass = 1\n"));
  CHECK_THAT(stiff, Catch::Contains("nothing can move"));
  CHECK_THAT(stiff, Catch::Contains("fixed of O"));
}

// O-B-C is an arch of rods that are longer than their nodes are apart: B rises as the square root of what the
// lengths grow by, where steps that keep the first Jacobian would come nearer by a third at a time only. D
// and E lie in line with O-B, and rise two and three times as much, at most by a fifth of a rod.
TEST_CASE("a flat arch is fitted to its lengths and refused where it moves too far at every size") {
  const auto arch = [](double size, double from, double to) {
    const auto at = [&](double x, double y) {
      return "position = [" + testing::number(size * x) + ", " + testing::number(size * y) + ", 0]";
    };
    const std::string length = "mass = 0.3, length = " + testing::number(size * std::hypot(1, to)) + "}";
    return "[structure]\nkind = 'custom'\nnodes = [{name = 'O', fixed = true, " + at(0, 0) +
           "}, {name = 'C', fixed = true, " + at(2, 0) + "}, {name = 'B', " + at(1, from) +
           "}, {name = 'D', " + at(2, 2 * from) + "}, {name = 'E', " + at(3, 3 * from) + "}, {name = 'P', " +
           at(0.3, -0.8) + "}]\nrods = [{nodes = ['O', 'B'], " + length + ", {nodes = ['B', 'C'], " + length +
           ", {nodes = ['B', 'D'], " + length + ", {nodes = ['D', 'E'], " + length +
           ", {nodes = ['O', 'P'], mass = 0.1}]\n[[constraints]]\nkind = 'plane'\nnodes = ['B', 'D', 'E']\n"
           "normal = [0, 0, 1]\n[[constraints]]\nkind = 'collinear'\nnodes = ['O', 'B', 'D', 'E']\n";
  };
  for (const double size : {1.0, 0.013, 210.0}) {
    INFO(size);
    const auto model = model_of(arch(size, 0.1, 0.16));
    for (const int k : {1, 2, 3}) {
      const Vec3 wanted = k * size * Vec3(1, 0.16, 0);
      const Vec3& found = model->structure.nodes[static_cast<std::size_t>(k + 1)].position;
      CHECK((found - wanted).norm() < 1e-11 * size);  // rounding of lengths over the slope of the arch
    }
    CHECK_THAT(error_of(arch(size, 0.02, 0.14)), Catch::Contains("no pose close to the given one"));
  }
}

}  // namespace fit_lengths_test
