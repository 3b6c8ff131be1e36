// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/write_back.hpp"

#include <catch2/catch.hpp>
#include <tuple>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"

using namespace unfurl;

namespace write_back_test {

namespace {

constexpr const char* hoop = R"(# ünïcode before everything
title = "Ring" # a title

[structure]
kind = "hoop"        # the family
units   =   6
post_length = 1.2    # m

# between the tables
[solver]
step = 0.01          # s
method = 'dvm'

[[loads]]
nodes = ["B0", # first
         "B1"]
force = [0, 0, -1.0]   # N
)";

// One entry that stands for two; a value of one of them has no place.
constexpr const char* two_dampers = R"([structure]
kind = "hoop"
units = 6
[[forces]]
repeat = {i = "0:2"}
kind = "drag"
nodes = ["B{i}"]
damping = 1.0
)";
constexpr const char* of_the_second = "forces[1].damping=2.0";

std::string back(const std::vector<std::string>& overrides) {
  const WrittenBack result = write_back(hoop, "ring.toml", overrides, "");
  CHECK_FALSE(result.anew);
  return result.text;
}

std::string with(std::string from, const std::string& to) {
  std::string text = hoop;
  const auto at = text.find(from);
  REQUIRE(at != text.npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("written back, a changed value changes nothing else of a scene file") {
  CHECK(back({}) == hoop);
  CHECK(back({"solver.step=0.02"}) == with("step = 0.01 ", "step = 0.02 "));
  CHECK(back({"structure.units=8"}) == with("units   =   6", "units   =   8"));
  CHECK(back({"solver.method=rk4"}) == with("'dvm'", "\"rk4\""));
  CHECK(back({"loads[0].force=[1.0, 2.0, 3.0]"}) == with("[0, 0, -1.0]", "[1.0, 2.0, 3.0]"));
  CHECK(back({"title=\"Other\""}) == with("\"Ring\"", "\"Other\""));
}

TEST_CASE("written back, entries are found by their place, the first and the tenth") {
  std::string text = "[structure]\nkind = 'custom'\n";
  for (int i = 0; i < 12; ++i)
    text += "[[structure.nodes]]\nname = 'N" + std::to_string(i) + "'\nposition = [" + std::to_string(i) +
            ", 0, 0]\nmass = 2\n";
  for (const int i : {0, 3, 10, 11}) {
    const std::string n = std::to_string(i);
    const WrittenBack result = write_back(text, "n.toml", {"structure.nodes[" + n + "].mass=7"}, "");
    const std::string before = "position = [" + n + ", 0, 0]\nmass = ";
    std::string expected = text;
    expected[expected.find(before) + before.size()] = '7';
    CHECK(result.text == expected);
    const WrittenBack moved = write_back(text, "n.toml", {"structure.nodes[" + n + "].position[1]=0.5"}, "");
    CHECK(read_scene_text(moved.text, "n.toml").custom.nodes[static_cast<std::size_t>(i)].position[1] == 0.5);
  }
}

TEST_CASE("written back, columns count characters of one to four bytes") {
  const std::string text =
      "[structure]\nkind = \"custom\"\nnodes = [{name = \"\u00C4\u4E16\U0001F6F0\", mass = 5, position = [0, "
      "0, 0]}, "
      "{name = \"B\", mass = 7, position = [1, 0, 0]}]\nrods = [{name = \"r\", nodes = "
      "[\"\u00C4\u4E16\U0001F6F0\", \"B\"], mass = 1}]\n";
  for (const auto& [key, from, to] : {std::tuple("structure.nodes[0].mass=6", "mass = 5", "mass = 6"),
                                      std::tuple("structure.nodes[1].mass=8", "mass = 7", "mass = 8")}) {
    const WrittenBack result = write_back(text, "custom.toml", {key}, "");
    CHECK_FALSE(result.anew);
    std::string expected = text;
    expected.replace(expected.find(from), 8, to);
    CHECK(result.text == expected);
  }
}

TEST_CASE("written back, a new key stands behind the others of its table, a new table at the end") {
  CHECK(back({"solver.end_time=2.5"}) == with("method = 'dvm'\n", "method = 'dvm'\nend_time = 2.5\n"));
  std::string with_gravity = hoop;
  with_gravity.append("\n[gravity]\nacceleration = [0.0, 0.0, -9.81]\n");
  CHECK(back({"gravity.acceleration=[0.0, 0.0, -9.81]"}) == with_gravity);
}

TEST_CASE("written back, a new entry of a list is a table of its own at the end, comments and all stay") {
  const std::string motor =
      "constraints[0]={kind = \"angle\", name = \"motor, no. 1\", fold_angle = true, motion = \"rate\"}";
  const std::string hinge = "forces[0]={kind = \"drag\", nodes = [\"B0\", \"B1\"], damping = 1e-3}";
  CHECK(
      back({motor, "constraints[0].rate=-8.0", hinge}) ==
      std::string(hoop) +
          "\n[[constraints]]\nkind = \"angle\"\nname = \"motor, no. 1\"\nfold_angle = true\nmotion = "
          "\"rate\"\nrate = -8.0\n\n[[forces]]\nkind = \"drag\"\nnodes = [\"B0\", \"B1\"]\ndamping = 1e-3\n");
  CHECK(back({"loads[1]={nodes = [\"B2\"], force = [0.0, 0.0, 2.0]}", "loads[0].enabled=false"}) ==
        with("-1.0]   # N\n",
             "-1.0]   # N\nenabled = false\n\n[[loads]]\nnodes = [\"B2\"]\nforce = [0.0, 0.0, 2.0]\n"));
}

TEST_CASE("what cannot be written into the text is written anew and means the same") {
  const std::string text = two_dampers;
  const WrittenBack result = write_back(text, "x.toml", {of_the_second}, "");
  CHECK(result.anew);
  CHECK(scene_text(read_scene_text(result.text, "x.toml")) ==
        scene_text(read_scene_text(text, "x.toml", {of_the_second})));
}

TEST_CASE("every scene of the library takes changes in place") {
  REQUIRE(library_scenes().size() >= 6);
  for (const LibraryScene& row : library_scenes()) {
    INFO(row.name);
    const std::string text = read_text_file(row.path).text, folder = row.path.substr(0, row.path.rfind('/'));
    const WrittenBack result =
        write_back(text, row.path, {"solver.step=0.0123", "gravity.acceleration=[0.0, 0.0, -1.5]"}, folder);
    CHECK_FALSE(result.anew);
    const Scene scene = read_scene_text(result.text, row.path, {}, folder);
    CHECK(scene.solver.step == 0.0123);
    CHECK(scene.gravity.z() == -1.5);
    // No comment is lost.
    CHECK(std::count(result.text.begin(), result.text.end(), '#') ==
          std::count(text.begin(), text.end(), '#'));
  }
}

// A name leads to the entry that has it, and its index to the same.
TEST_CASE("written back, an entry goes by its name as by its place") {
  const std::string text = R"(title = "W"  # mine
[variables]
m = 2
[structure]
kind = "custom"  # of rods
nodes = [{name = "A", position = [0, 0, 0], fixed = true},  # the hinge
         {name = "B 1", position = [1, 0, 0], mass = "=m"}]
[[structure.rods]]
nodes = ["A", "B 1"]
mass = 1  # kg
[[forces]]
kind = "spring"
name = "s"
nodes = ["A", "B 1"]
stiffness = 3
)";
  const auto changed = [&](const std::string& key, const std::string& value) {
    const WrittenBack result = write_back(text, "w.toml", {key + "=" + value}, "");
    CAPTURE(key);
    CHECK_FALSE(result.anew);
    return result.text;
  };
  const auto check_same = [&](const std::string& place, const std::vector<std::string>& keys) {
    const std::string by_place = changed(place, "7.5");
    CHECK(by_place != text);
    for (const std::string& key : keys) CHECK(changed(key, "7.5") == by_place);
  };
  check_same("structure.nodes[1].mass",
             {"structure.nodes[B 1].mass", "structure.nodes.\"B 1\".mass", "structure.nodes[\"B 1\"].mass"});
  check_same("structure.rods[0].mass", {"structure.rods[A-B 1].mass", "structure.rods.A-B 1.mass"});
  check_same("structure.rods[0].area", {"structure.rods[A-B 1].area"});  // a new key of that entry
  check_same("forces[0].stiffness", {"forces[s].stiffness", "forces.s.stiffness"});
}

// A title that says what was changed is of one command, not of the file.
TEST_CASE("written anew a scene keeps the title that its file gives") {
  for (const std::string title : {"Ring", "Ring of {units}", "Ring {{a}}", ""}) {
    const std::string first = title.empty() ? "" : "title = \"" + title + "\"\n";
    const std::string text = first + two_dampers;
    const WrittenBack result = write_back(text, "x.toml", {of_the_second}, "");
    REQUIRE(result.anew);
    CHECK(result.text.starts_with("title = \"" + (title.empty() ? "x" : title) + "\"\n"));
    CHECK(write_back(text, "x.toml", {of_the_second, "title=\"Other\""}, "")
              .text.starts_with("title = \"Other\"\n"));
  }
}

TEST_CASE("overrides that make no sound scene are refused, not written") {
  CHECK_THROWS_AS(write_back(hoop, "ring.toml", {"structure.units=2"}, ""), SceneError);
  CHECK_THROWS_AS(write_back(hoop, "ring.toml", {"structure.unit=8"}, ""), SceneError);
}

}  // namespace write_back_test
