// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/title.hpp"

#include <catch2/catch.hpp>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"

using namespace unfurl;

namespace title_test {

namespace {

std::string library_title(const char* scene, const std::vector<std::string>& changes) {
  return read_scene_file(find_scene(scene), changes).title;
}

Scene written(const std::string& title, const std::vector<std::string>& changes = {}) {
  return read_scene_text("title = '" + title + "'\n[structure]\nkind = 'hoop'\nunits = 9\n", "mine.toml",
                         changes);
}

}  // namespace

TEST_CASE("the titles of the library say how many parts there are, whatever the file says") {
  CHECK(library_title("hoop6", {}) == "Six-unit ring antenna");
  CHECK(library_title("hoop6", {"structure.units=24"}) == "24-unit ring antenna");
  CHECK(library_title("hoop6", {"structure.units=3"}) == "Three-unit ring antenna");
  CHECK(library_title("hoop6_motor", {"structure.units=7"}) == "Seven-unit ring antenna, opened by a motor");
  CHECK(library_title("hoop12", {}) == "Twelve-unit ring antenna");
  CHECK(library_title("scissor_mast", {"structure.cells=13"}) == "Scissor mast of 13 cells");
  CHECK(library_title("scissor_mast_square", {"structure.sides=3"}) == "Scissor mast with three sides");
  for (const LibraryScene& scene : library_scenes()) {
    INFO(scene.name);
    CHECK(scene.title == read_scene_file(scene.path).title);
    CHECK(scene.title.find('{') == std::string::npos);
  }
}

TEST_CASE("a title that names no parameter is dropped where the structure is another") {
  CHECK(library_title("pendulum", {}) == library_title("pendulum", {"solver.end_time=1", "render.fps=10"}));
  CHECK(library_title("pendulum", {"structure.angle=33"}) == "pendulum: angle = 33");
  CHECK(written("Nine bays").title == "Nine bays");
  CHECK(written("Nine bays", {"structure.units=9"}).title == "Nine bays");
  CHECK(written("Nine bays", {"structure.units=11", "structure.density=2e3"}).title ==
        "mine: units = 11, density = 2000");
  CHECK(written("Nine bays", {"structure.units=11", "title=Eleven bays"}).title == "Eleven bays");
  CHECK(written("Nine bays", {"structure.model=full"}).title == "Nine bays");  // its default
  CHECK(written("Nine bays", {"structure.model=sector"}).title == "mine: model = sector");
  const std::string custom =
      "title = 'A stone'\n[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = "
      "[0, 0, 1], mass = 2}]\n";
  CHECK(read_scene_text(custom, "stone.toml", {"structure.nodes.A.mass=3"}).title == "stone: nodes changed");
  CHECK(read_scene_text(custom, "stone.toml", {"structure.nodes.A.mass=2.0"}).title == "A stone");
}

TEST_CASE("a place in a title takes a key of the structure, its default too, and must be one") {
  CHECK(written("{units} bays of {chord_rod_length} m, {model}").title == "Nine bays of 3 m, full");
  for (const std::string key : {"of", "variables.n", "structure.units"}) try {
      written("Ring {" + key + "} braces");
      FAIL("was read: " + key);
    } catch (const SceneError& error) {
      REQUIRE(error.problems().size() == 1);
      CHECK(error.problems()[0].key == "title");
      CHECK(error.problems()[0].message == "{" + key +
                                               "} names no number or text of [structure], whose keys a title "
                                               "takes, no variables; a brace is {{");
    }
  CHECK(written("A set {1, 2} or {a b}").title == "A set {1, 2} or {a b}");
  CHECK(written("Of {0.5} m and {.x}").title == "Of {0.5} m and {.x}");
  CHECK(written("No set {}, none { or }").title == "No set {}, none { or }");
  CHECK(written("{} and {units} of {a b} { {units}").title == "{} and nine of {a b} { nine");
}

TEST_CASE("a doubled brace is a brace") {
  CHECK(written("{{units}} of {units}").title == "{units} of nine");
  CHECK(written("{{{units}}} }} {{").title == "{nine} } {");
  CHECK(written("{{units}}").title == "{units}");
  CHECK(written("{{units}}").title_pattern.empty());
  CHECK(written("{{units}}", {"structure.units=5"}).title == "mine: units = 5");  // it names no parameter
}

// Doubled only where a single brace would mean something else.
TEST_CASE("a title with single braces is written as it stands where it says no more than that") {
  CHECK(title_that_says("none { or } of them") == "none { or } of them");
  CHECK(title_that_says("{units}") == "{{units}}");
  CHECK(title_that_says("{{ and }") == "{{{{ and }}");
}

// A scene without a title is called by its file's name, which is no pattern whatever is in it.
TEST_CASE("a file's name in braces survives writing and reading, and is no place of the title") {
  const std::string hoop = "[structure]\nkind = 'hoop'\n";
  for (const std::string name :
       {"x{foo}", "r{units}", "{{units}}", "{units", "units}", "}{", "{{", "a{{{units}b}}", "{}", "{a b}"}) {
    INFO(name);
    const Scene scene = read_scene_text(hoop, name + ".toml");
    REQUIRE(scene.title == name);
    std::string text = scene_text(scene);
    for (int generation = 0; generation < 3; ++generation) {
      const Scene again = read_scene_text(text, "scene.toml");
      CHECK(again.title == name);
      CHECK(scene_text(again) == text);
      text = scene_text(again);
    }
  }
  // What says what was changed begins with that name, too.
  const Scene changed = read_scene_text("title = 'Mine'\n" + hoop, "x{units}.toml", {"structure.units=8"});
  CHECK(changed.title == "x{units}: units = 8");
  CHECK(read_scene_text(scene_text(changed), "scene.toml").title == changed.title);
}

TEST_CASE("the scene as run keeps the title's places") {
  const Scene scene = written("{units}-bay ring", {"structure.units=5"});
  CHECK(scene.title == "Five-bay ring");
  const std::string text = scene_text(scene);
  CHECK(read_scene_text(text, "again.toml").title == "Five-bay ring");
  CHECK(read_scene_text(text, "again.toml", {"structure.units=6"}).title == "Six-bay ring");
}

}  // namespace title_test
