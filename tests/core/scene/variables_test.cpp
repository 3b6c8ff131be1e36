// SPDX-License-Identifier: BSD-3-Clause
// Scenes with variables mean the same as scenes that spell everything out.
#include "core/scene/variables.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"
#include "core/scene/write_back.hpp"

using namespace unfurl;

namespace variables_test {

namespace {

// A hanging polygon of n rods, as scenes with variables say it.
const std::string polygon = R"toml([variables]
n = 5
radius = "=1 + 1/4"          # m
[structure]
kind = "custom"
[[structure.nodes]]
repeat = {i = "0:n"}
name = "P{i}"
position = ["=radius*cos(2*pi*i/n)", 0, "=radius*sin(2*pi*i/n)"]
[[structure.nodes]]
name = "top"
position = [0, 0, "=2*radius"]
fixed = true
[[structure.rods]]
repeat = {i = "0:n"}
nodes = ["P{i}", "P{(i+1) % n}"]
mass = "=(i+1)/8"
[[structure.rods]]
nodes = ["top", "P1"]
mass = 0.5
[[constraints]]
repeat = {k = [0, "=n-2"], axis = [0, 1]}
kind = "plane"
name = "plane {k} {axis}"
nodes = ["P{k}"]
normal = ["=axis", "=1-axis", 0]
)toml";

Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_scene_text(text, "polygon.toml", overrides);
}

std::string mistakes(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("repeated entries stand once for every value") {
  const Scene scene = read(polygon);
  REQUIRE(scene.custom.nodes.size() == 6);
  REQUIRE(scene.custom.rods.size() == 6);
  for (std::size_t i = 0; i < 5; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / 5;
    CHECK(scene.custom.nodes[i].name == "P" + std::to_string(i));
    CHECK(scene.custom.nodes[i].position.x() == Approx(1.25 * std::cos(angle)).epsilon(0).margin(1e-15));
    CHECK(scene.custom.nodes[i].position.z() == Approx(1.25 * std::sin(angle)).epsilon(0).margin(1e-15));
    CHECK(scene.custom.rods[i].nodes ==
          std::vector<std::string>{"P" + std::to_string(i), "P" + std::to_string((i + 1) % 5)});
    CHECK(scene.custom.rods[i].mass == static_cast<double>(i + 1) / 8);
  }
  CHECK(scene.custom.nodes[5].position.z() == 2.5);
  CHECK_NOTHROW(build_model(scene));
}

// 2.1 / 0.7 is 3.0000000000000004 in doubles, 2.7 / 0.3 is 9.000000000000002.
TEST_CASE("a count that is whole but for rounding is whole") {
  for (const auto& [length, cell, count] :
       {std::tuple{"2.1", "0.7", 3}, std::tuple{"2.7", "0.3", 9}, std::tuple{"2.0", "0.5", 4}}) {
    INFO(length << " / " << cell);
    const Scene scene =
        read_scene_text(std::string("[variables]\nL = ") + length + "\ncell = " + cell +
                            "\nn = '=L/cell'\n[structure]\nkind = 'custom'\n[[structure.nodes]]\n"
                            "repeat = {i = '0:n'}\nname = 'N{i}'\nposition = ['=i', '=i*i', 0]\n"
                            "fixed = true\n[[structure.rods]]\nrepeat = {i = '0:n'}\n"
                            "nodes = ['N{i}', 'N{(i+1)%n}']\nmass = 1\n",
                        "s.toml");
    CHECK(scene.custom.nodes.size() == static_cast<std::size_t>(count));
    CHECK(scene.custom.rods.back().nodes.back() == "N0");
  }
}

// A tape of 20 mm x 10 um: b t^3 / 12 = 1.67e-18 m^4, and 0 would mean another section.
TEST_CASE("a small quantity that is worked out is not rounded to zero") {
  const Scene scene = read_scene_text(
      "[variables]\nb = 0.02\nt = 1e-5\nI = '=b*t^3/12'\nk = '=0.1*3-0.3'\n[structure]\nkind = 'custom'\n"
      "nodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', position = [1, 0, 0]}]\n"
      "rods = [{nodes = ['A', 'B'], mass = '=k', second_moment = '=I'}]\n"
      "[[constraints]]\nkind = 'combination'\nterms = ['{I} length A B']\n",
      "s.toml");
  const double t = 1e-5;
  CHECK(scene.custom.rods[0].second_moment ==
        0.02 * (t * t * t) / 12);                     // both within a rounding of one product
  CHECK(scene.custom.rods[0].mass == 0.1 * 3 - 0.3);  // 5.6e-17: what rounding is, nobody knows
  CHECK(scene.constraints[0].terms[0].find("1.6666") != std::string::npos);
}

TEST_CASE("two variables of a repeat: the last one runs fastest") {
  const std::string text = scene_text(read(polygon));
  std::size_t at = 0;
  for (const char* name : {"plane 0 0", "plane 0 1", "plane 3 0", "plane 3 1"}) {
    INFO(name);
    at = text.find("\"" + std::string(name) + "\"", at);
    REQUIRE(at != std::string::npos);
  }
}

TEST_CASE("whole numbers stand in names without an exponent") {
  const Scene scene = read(
      "[variables]\nk = 100000\n[structure]\nkind = 'custom'\n"
      "nodes = [{name = 'A{k}', position = [0, 0, 0], fixed = true},\n"
      "{name = 'B{-2*k}', position = [1, 0, 0]}, {name = 'C{k/8e5}', position = [2, 0, 0]},\n"
      "{name = 'D{0*-1}', position = [3, 0, 0]}]\n"
      "rods = [{nodes = ['A100000', 'B-200000'], mass = 1}, {nodes = ['B-200000', 'C0.125'], mass = 1},\n"
      "{nodes = ['C0.125', 'D0'], mass = 1}]\n");
  CHECK(build_structure(scene).nodes.size() == 4);
}

TEST_CASE("variables are set on the command line") {
  const Scene scene =
      read(polygon, {"variables.n=8", "variables.radius=\"=n/2\"", "structure.nodes.P7.mass=3"});
  CHECK(scene.custom.nodes.size() == 9);
  CHECK(scene.custom.nodes[0].position.x() == 4.0);
  CHECK(scene.custom.nodes[7].mass == 3.0);
  CHECK(mistakes(polygon, {"variables.radiuss=2"}) ==
        "--set variables.radiuss: the scene has no such variable; did you mean 'radius'?");
  CHECK(mistakes(polygon, {"radius=2"}) == "--set radius: unknown key; did you mean 'variables.radius'?");
  CHECK(read(polygon, {"solver.step=\"=radius/125\""}).solver.step == 0.01);
}

TEST_CASE("the scene that a run writes is spelt out and means the same") {
  const std::string spelt = scene_text(read(polygon));
  CHECK(spelt.find("repeat") == std::string::npos);
  CHECK(scene_text(read(spelt)) == spelt);
}

TEST_CASE("values are written back into scenes with variables") {
  const WrittenBack variable = write_back(polygon, "polygon.toml", {"variables.n=7"}, "");
  CHECK_FALSE(variable.anew);
  CHECK(variable.text == with(polygon, "n = 5", "n = 7"));
  // A single one of the repeated entries has no place in the file: all are spelt out.
  const WrittenBack entry = write_back(polygon, "polygon.toml", {"structure.nodes[3].mass=2"}, "");
  CHECK(entry.anew);
  CHECK(read(entry.text).custom.nodes[3].mass == 2.0);
}

TEST_CASE("a wrong variable is told once, and not again wherever it is used") {
  const std::string once = mistakes(with(polygon, "n = 5", "n = \"=5 +\""));
  CHECK(once.starts_with("polygon.toml:"));
  CHECK(once.find("variables.n: in the expression") != std::string::npos);
  CHECK(once.find("no variable") == std::string::npos);
  // Nor of what is worked out of it; another mistake stays.
  const std::string two = mistakes(with(with(polygon, "n = 5", "n = [5]"), "\"=2*radius\"", "\"=2*q\""));
  CHECK(two.find("variables.n: must be a finite number") != std::string::npos);
  CHECK(two.find("no variable 'q'") != std::string::npos);
  CHECK(two.find("'n'") == std::string::npos);
  CHECK(mistakes(with(polygon, "[variables]\n", "[variablez]\n")).find("no variable") != std::string::npos);
}

TEST_CASE("mistakes in variables and repeats have a place") {
  CHECK(mistakes(with(polygon, "cos(2*pi*i/n)", "cos(2*pi*i/m)"))
            .starts_with("polygon.toml:9:13: structure.nodes[0].position[0]: in the expression "
                         "'radius*cos(2*pi*i/m)', character 19: no variable 'm'; known: i, n, radius, "));
  CHECK(
      mistakes(with(polygon, "\"P{i}\"\n", "\"P{i\"\n"))
          .find("polygon.toml:8:8: structure.nodes[0].name: a brace stands alone in 'P{i'; write it twice") ==
      0);
  for (const char* alone : {"P}{i}", "{i}}P", "P}"})
    CHECK(mistakes(with(polygon, "\"P{i}\"\n", '"' + std::string(alone) + "\"\n"))
              .find("a brace stands alone in '" + std::string(alone)) != std::string::npos);
  CHECK(mistakes(with(polygon, "{i = \"0:n\"}", "\"0:n\""))
            .find("polygon.toml:7:10: structure.nodes[0].repeat: must be a table such as {i = \"0:n\"}") ==
        0);
  CHECK(mistakes(with(polygon, "{i = \"0:n\"}", "{i = 7}")).find("must be a range \"FROM:END\"") !=
        std::string::npos);
  CHECK(mistakes(with(polygon, "{i = \"0:n\"}", "{n = \"0:3\"}"))
            .find("structure.nodes[0].repeat.n: is the name of another variable") != std::string::npos);
  CHECK(mistakes(with(polygon, "{i = \"0:n\"}", "{i = \"0:9e9\"}")).find("more than 100000 entries") !=
        std::string::npos);
  CHECK(mistakes(with(polygon, "{i = \"0:n\"}", "{i = \"n:0\"}"))
            .find("structure.nodes[0].repeat.i: must not end before it begins; got 'n:0'") !=
        std::string::npos);
  const std::string loops = "{i = \"0:90000\", j = \"0:90000\", k = []}";  // none of them makes an entry
  CHECK(mistakes(with(polygon, "{i = \"0:n\"}", loops)).find("more than 100000 entries") !=
        std::string::npos);
  CHECK(mistakes(with(polygon, "n = 5", "n = true")).find("variables.n: must be a finite number") !=
        std::string::npos);
  // The order matters, and is named; a variable that is nowhere, or the one itself, is none.
  const std::string order = "variables.radius: in the expression '1 + 1/k', character 7: ";
  CHECK(mistakes(with(polygon, "radius = \"=1 + 1/4\"", "radius = \"=1 + 1/k\"\nk = 4"))
            .find(order + "'k' stands below: a variable may use those above it; move one of them") !=
        std::string::npos);
  CHECK(mistakes(with(polygon, "radius = \"=1 + 1/4\"", "radius = \"=1 + 1/k\""))
            .find(order + "no variable 'k'") != std::string::npos);
  CHECK(mistakes(with(polygon, "radius = \"=1 + 1/4\"", "k = \"=1 + k\"\nradius = 1"))
            .find("no variable 'k'") != std::string::npos);
  // Where two need each other, directly or through a third, no order helps.
  const auto from = [](const std::string& first, const std::string& rest) {
    return mistakes(with(polygon, "radius = \"=1 + 1/4\"", "radius = \"=" + first + "\"\n" + rest));
  };
  const std::string cycle = "'k' is worked out of 'radius' in its turn: give one of them a number";
  CHECK(from("2*k", "k = \"=radius/2\"").find(cycle) != std::string::npos);
  CHECK(from("2*k", "k = \"=m\"\nm = \"=1 + radius\"").find(cycle) != std::string::npos);
  // Also of a name that begins as a constant does.
  CHECK(mistakes(with(polygon, "n = 5", "n = '=5 + pitch'\npitch = '=sine'\nsine = '=n'"))
            .find("'pitch' is worked out of 'n' in its turn") != std::string::npos);
  CHECK(from("2*k", "k = \"=m\"\nm = \"=k + radius_2\"\nradius_2 = 1").find("'k' stands below") !=
        std::string::npos);
  // One mistake in an entry that stands many times is told once.
  const std::string twice = mistakes(with(polygon, "mass = \"=(i+1)/8\"", "mas = 1"));
  CHECK(twice.find("unknown key") == twice.rfind("unknown key"));
}

TEST_CASE("scenes without variables keep their braces and titles") {
  const Scene scene = read(
      "title = \"= {A}\"\n[structure]\nkind = \"custom\"\n[[structure.nodes]]\nname = \"{A}\"\n"
      "position = [0, 0, \"=sqrt(4)\"]\n[[structure.nodes]]\nname = \"B\"\nposition = [1, 0, 2]\n"
      "[[structure.rods]]\nnodes = [\"{A}\", \"B\"]\nmass = 1\n");
  CHECK(scene.title == "= {A}");
  CHECK(scene.custom.nodes[0].name == "{A}");
  CHECK(scene.custom.nodes[0].position.z() == 2.0);
}

TEST_CASE("a variable that is no finite number is refused by its name") {
  for (const char* value : {"inf", "-inf", "nan", "true", "'12'", "[1]"}) {
    const std::string said =
        mistakes(with(polygon, "radius = \"=1 + 1/4\"", std::string("radius = ") + value));
    INFO(value << ": " << said);
    CHECK(said.find("variables.radius") != std::string::npos);
    CHECK(said.find("must be a finite number or an expression") != std::string::npos);
  }
}

TEST_CASE("a variable of which nothing is worked out is warned of and one that others replace is not") {
  const std::string idle = with(polygon, "n = 5", "n = 5\npitch = 1\nhalf = '=pitch/2'"),
                    used = idle + "[[loads]]\nnodes = ['top']\nforce = ['=half/2', 0, 0]\n";
  const auto warned = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::string all;
    for (const SceneProblem& warning : read(text, overrides).warnings)
      if (warning.key.starts_with("variables."))
        all += std::to_string(warning.where.line) + " " + warning.key.substr(10) + ", ";
    return all;
  };
  CHECK(warned(polygon) == "");
  CHECK(warned(idle) == "4 half, 3 pitch, ");  // what only an idle one is worked out of is idle, too
  CHECK(warned(used) == "");
  CHECK(warned(with(idle, "radius = \"=1", "radius = \"=0*half + 1")) == "");
  // The same expression of a variable and of what is used.
  CHECK(warned(with(used, "force = ['=half/2'", "force = ['=pitch/2'")) == "4 half, ");
  CHECK(warned(used, {"variables.half=2"}) == "");
  CHECK(warned(used, {"variables.half=2", "variables.pitch=3"}) == "0 pitch, ");
}

}  // namespace variables_test
