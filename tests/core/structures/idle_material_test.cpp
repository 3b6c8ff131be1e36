// SPDX-License-Identifier: BSD-3-Clause
// What of a rod's material does nothing says so.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/scene/library.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace idle_material_test {

namespace {

// How many notes of a structure begin so.
long notes(const Structure& structure, const std::string& begin) {
  return std::ranges::count_if(structure.notes,
                               [&](const std::string& note) { return note.starts_with(begin); });
}

long notes_of(const char* scene, const std::vector<std::string>& changes, const std::string& begin) {
  return notes(build_structure(read_scene_file(find_scene(scene), changes)), begin);
}

// A triangle whose rods have no modulus unless the structure gives one.
long notes_of_rods(const std::string& of_all, const std::string& of_first, const std::string& begin) {
  const std::string text =
      "[structure]\nkind = 'custom'\n" + of_all +
      "nodes = [{name = 'A', position = [0, 0, 0]}, {name = 'B', position = [1, 0, 0]},"
      "{name = 'C', position = [0, 1, 0]}]\n"
      "rods = [{nodes = ['A', 'B'], mass = 1, area = 1e-4" +
      of_first + "}, {nodes = ['B', 'C'], mass = 1, area = 1e-4}, {nodes = ['C', 'A'], mass = 1}]\n";
  return notes(testing::model_of(text)->structure, begin);
}

}  // namespace

TEST_CASE("a strength or section without a modulus does nothing, and is noted in every family") {
  for (const char* scene : {"hoop6", "scissor_mast", "chain", "bricard"})
    for (const auto& [key, value] : {std::pair("strength", "1e8"), std::pair("section", "square")}) {
      INFO(scene << " " << key);
      const std::string change = std::string("structure.") + key + "=" + value;
      const std::string does_nothing = std::string(key) + " does nothing";
      CHECK(notes_of(scene, {change}, does_nothing) == 1);
      CHECK(notes_of(scene, {}, does_nothing) == 0);
      CHECK(notes_of(scene, {change, "structure.youngs_modulus=7e10", "structure.section_area=1e-4"},
                     does_nothing) == 0);
    }
}

// Of a scissor at 60 degrees under 1000 N one half of an arm bears 1750 N and the other one 250 N; its length
// has one force, 1000 N.
TEST_CASE("stress and margins of rods with pins between their ends are said to be those of their mean") {
  const std::string pins = "stress, buckling and strength of ";
  CHECK(notes_of("scissor_mast", {"structure.cells=2", "structure.youngs_modulus=7e10"}, pins + "4 rods") ==
        1);
  CHECK(notes_of("scissor_ring", {"structure.youngs_modulus=7e10"}, pins) == 1);
  CHECK(notes_of("scissor_mast", {}, pins) == 0);
  // No pin lies between the ends of a rod: posts of the other two are only held parallel.
  for (const char* scene : {"hoop6", "hoop_arc", "cable_ring"})
    CHECK(notes_of(scene, {"structure.youngs_modulus=7e10"}, pins) == 0);
  CHECK(notes_of("hoop6", {"structure.youngs_modulus=7e10", "structure.model=joints"}, pins) == 0);
}

TEST_CASE("in a custom structure a rod's own strength without a modulus is noted with its name") {
  CHECK(notes_of_rods("strength = 1e8\n", "", "strength does nothing") == 1);
  CHECK(notes_of_rods("segments = 3\n", "", "segments does nothing") == 1);
  CHECK(notes_of_rods("segments = 3\n", ", youngs_modulus = 7e10", "segments does nothing") == 0);
  CHECK(notes_of_rods("", ", strength = 1e8", "strength of rod A-B does nothing") == 1);
  CHECK(notes_of_rods("", ", strength = 1e8, youngs_modulus = 7e10", "strength") == 0);
  CHECK(notes_of_rods("", ", strength = inf", "strength") ==
        0);  // the default, as `unfurl new custom` has it
  CHECK(notes_of_rods("", ", second_moment = 1e-9", "second_moment of rod A-B does nothing") == 1);
}

}  // namespace idle_material_test
