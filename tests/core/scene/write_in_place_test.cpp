// SPDX-License-Identifier: BSD-3-Clause
// Scene files in every way of writing, and keys of every table: what is written back differs from what was
// there in one place, and means what the text and the override mean together.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/scene/write_back.hpp"

using namespace unfurl;

namespace write_in_place_test {

namespace {

struct Change {
  std::string removed, added;
};

// Between the longest common beginning and end: texts that differ in one place differ in nothing else.
Change between(const std::string& before, const std::string& after) {
  std::size_t first = 0, last = 0;
  const std::size_t shorter = std::min(before.size(), after.size());
  while (first < shorter && before[first] == after[first]) ++first;
  while (last < shorter - first && before[before.size() - 1 - last] == after[after.size() - 1 - last]) ++last;
  return {before.substr(first, before.size() - first - last),
          after.substr(first, after.size() - first - last)};
}

long count_of(const std::string& text, const std::string& part) {
  long count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

Change check_in_place(const std::string& text, const std::string& set, const std::string& folder = "") {
  CAPTURE(text, set);
  const WrittenBack result = write_back(text, "x.toml", {set}, folder);
  CHECK_FALSE(result.anew);
  CHECK(result.lost.empty());
  Scene meant = read_scene_text(text, "x.toml", {set}, folder),
        written = read_scene_text(result.text, "x.toml", {}, folder);
  if (!set.starts_with("title=")) written.title = meant.title = "";  // the command's says what it changed
  CHECK(scene_text(written) == scene_text(meant));
  const Change change = between(text, result.text);
  CHECK(change.removed.find_first_of("#\n") == change.removed.npos);
  // No line break of another kind than the text's.
  if (text.find("\r\n") != text.npos)
    CHECK(std::ranges::count(result.text, '\n') == count_of(result.text, "\r\n"));
  return change;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// The same scene as other editors and people write it.
std::vector<std::string> written_otherwise(const std::string& text) {
  std::vector<std::string> all{text, replaced(text, "\n", "\r\n"), "\xEF\xBB\xBF" + text,
                               replaced(text, "\n[", "\n# ü [x] = \"\n[")};
  std::string open = text;
  while (open.ends_with('\n')) open.pop_back();
  all.push_back(std::move(open));
  return all;
}

const std::vector<std::string> sets = {
    "title=\"new \\\"t\\\" é\"", "solver.step=0.003",          "solver.end_time=1.5",
    "render.look=\"dark\"",      "render.size=[320, 180]",     "gravity.acceleration=[0.0, 1.0, -2.0]",
    "structure.bob_mass=0.25",   "structure.rod_mass=2.5 # b", "structure.youngs_modulus=7e10"};

// Does the scene take it at all?
bool is_sound(const std::string& text, const std::string& set, const std::string& folder = "") {
  try {
    read_scene_text(text, "x.toml", {set}, folder);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

constexpr const char* custom = R"(# of nothing
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0], fixed = true},
  {name = "B", position = [1, 0, 0]},  # the tip
  {position = [2, 0, 0], name = "C"}
]
rods = [{nodes = ["A", "B"], mass = 1}, {nodes = ["B", "C"], mass = 1 } ]
)";

}  // namespace

TEST_CASE("written back, scenes of the library change in one place however they are written") {
  long tried = 0;
  for (const LibraryScene& row : library_scenes()) {
    const std::string folder = row.path.substr(0, row.path.rfind('/')), text = read_text_file(row.path).text;
    for (const std::string& otherwise : written_otherwise(text))
      for (const std::string& set : sets) {
        if (!is_sound(otherwise, set, folder)) continue;
        check_in_place(otherwise, set, folder);
        ++tried;
      }
  }
  CHECK(tried > 20 * 5 * 5);
}

TEST_CASE("written back, tables in every way of writing take what they have not had") {
  const std::vector<std::string> texts = {
      "# c\n[structure]\nkind = \"pendulum\"\n[render]\n# only a comment\n[solver]\nend_time = 1\n",
      "# c\n[structure]\nkind = \"pendulum\"\n[solver]\nend_time = 1\n\n[render]\n",
      "solver.end_time = 1\nstructure.kind = \"pendulum\"  # c\n",
      "# c\nstructure.kind = \"pendulum\"\nstructure . \"angle\" = 30 # a\nrender.size = [640, 360]\n",
      "structure = {kind = \"pendulum\", angle = 30}  # c\nsolver = { end_time = 1 }\nrender = {}\n",
      "[\"structure\"] # c\n\"kind\" = 'pendulum'\n'angle' = 30\n",
      "[structure]\nkind = \"pendulum\"\n[render]\ncamera_keys = [{time = 0, azimuth = 0},\n  {time = 1}] # "
      "c\n",
      "[structure]\nkind = \"pendulum\"\n[[render.camera_keys]]\ntime = 0\n[[render.camera_keys]]\ntime = "
      "1\n",
      "[render]\n[[render.camera_keys]]\ntime = 0\n[structure] # c\nkind = \"pendulum\"\n",
      "\t[structure]\n\t\tkind\t=\t\"pendulum\"\n\t\tangle\t=\t30\t# deg\n\t[render]\n",
      "# of the pendulum\n\n# its structure\n[structure]\nkind = \"pendulum\"\n\n# the end\n"};
  std::vector<std::string> all = sets;
  for (const char* set : {"structure.angle=45", "structure.length=2", "render.follow=true",
                          "forces[0]={kind=\"drag\", nodes=[\"*\"], damping=0.1}",
                          "loads[0]={nodes=[\"*\"], force=[0, 0, 1.5]}", "gravity.acceleration[1]=2.0"})
    all.push_back(set);
  long tried = 0;
  for (const std::string& text : texts)
    for (const std::string& otherwise : written_otherwise(text))
      for (const std::string& set : all) {
        if (!is_sound(otherwise, set)) continue;
        const Change change = check_in_place(otherwise, set);
        const std::string key = set.substr(set.find('.') + 1, set.find_first_of("=[") - set.find('.') - 1);
        if (otherwise.find(key) == otherwise.npos) CHECK(change.removed.empty());
        ++tried;
      }
  CHECK(tried > 11 * 5 * 8);
}

TEST_CASE("written back, entries of a list on one line take keys and neighbours inside its brackets") {
  for (const std::string& text : written_otherwise(custom)) {
    for (const char* set : {"structure.nodes[1].mass=2.5", "structure.nodes[C].mass=2.5",
                            "structure.nodes.B.velocity=[0.0, 1.0, 0.0]", "structure.nodes[2].velocity[1]=2",
                            "structure.rods[1].area=1e-4", "structure.rods[A-B].group=\"arm\""})
      CHECK(check_in_place(text, set).removed.empty());
    check_in_place(text, "structure.nodes[3]={name=\"D\", position=[3, 0, 0], fixed=true}");
    check_in_place(text, "structure.rods[2]={nodes=[\"A\", \"C\"], mass=1}");
  }
  CHECK(between(custom, write_back(custom, "x.toml", {"structure.nodes[2].mass=2.5"}, "").text).added ==
        ", mass = 2.5");
  CHECK(between(custom, write_back(custom, "x.toml", {"structure.rods[1].area=1e-4"}, "").text).added ==
        ", area = 1e-4");
}

TEST_CASE("written back, a title stands above the tables and below what the file says of itself") {
  const auto with_title = [](const std::string& text) {
    return write_back(text, "x.toml", {"title=T"}, "").text;
  };
  const std::string table = "[structure]\nkind = \"pendulum\"\n", line = "title = \"T\"\n\n";
  CHECK(with_title(table) == line + table);
  CHECK(with_title("# Mine\n" + table) == "# Mine\n" + line + table);
  CHECK(with_title("# Mine\n\n# of\n# rods\n" + table) == "# Mine\n\n" + line + "# of\n# rods\n" + table);
}

TEST_CASE("written back, entries under headers of their own give way to others in their place") {
  const std::string head = "# mine\n[structure]\nkind = \"pendulum\"\n", key = "[[render.camera_keys]]\n",
                    rest = "\n# of time\n[solver]\nend_time = 1\n";
  const std::string first = key + "time = 0\nazimuth = 9\n",
                    set = "render.camera_keys=[{time=0, zoom=2}, {time=1}]";
  const std::string made = key + "time = 0\nzoom = 2\n\n" + key + "time = 1\n";
  const auto changed = [&](const std::string& text) { return write_back(text, "x.toml", {set}, ""); };
  CHECK(changed(head + first + rest).text == head + made + rest);
  CHECK(changed(head + first + "\n" + first + rest).text == head + made + rest);
  CHECK(changed(head + rest + first).text == head + rest + made);
  CHECK(changed(head + first + "# one\n" + first + rest).lost == "comments");
  CHECK(changed(head + first + rest + first).anew);  // something stands between them
  CHECK(write_back(head + first + rest, "x.toml", {"render.camera_keys=[]"}, "").text == head + rest);
  for (const std::string& text : written_otherwise(head + first + "[render]\nlook = \"dark\"\n" + rest)) {
    CAPTURE(text);
    const WrittenBack result = changed(text);
    CHECK(result.lost.empty());
    CHECK_FALSE(result.anew);
    CHECK(scene_text(read_scene_text(result.text, "x.toml")) ==
          scene_text(read_scene_text(text, "x.toml", {set})));
  }
}

// What is lost with a scene that is written anew, and with a list that is replaced, is told.
TEST_CASE("written anew, what is lost of the user's own is told") {
  const std::string head = "[structure]\nkind = \"custom\"\n", tail = R"(
[[structure.nodes]]
name = "A"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
repeat = {i = "1:3"}
name = "B{i}"
position = ["=i", 0, 0]
[[structure.rods]]
nodes = ["A", "B1"]
mass = 1
)";
  const auto written = [](const std::string& text, const std::string& set) {
    const WrittenBack result = write_back(text, "x.toml", {set}, "");
    CHECK(said_of(result).empty() == (!result.anew && result.lost.empty()));
    return result;
  };
  const WrittenBack copy = written(head + tail, "structure.nodes[2].mass=2");
  CHECK(copy.anew);
  CHECK(copy.lost == "expressions, repeats");
  CHECK(written(head + tail + "[variables]\nn = 3\n", "structure.nodes[2].mass=2").lost ==
        "variables, expressions, repeats");
  CHECK(written("# mine\n" + head + tail, "structure.nodes[2].mass=2").lost ==
        "comments, expressions, repeats");
  CHECK_FALSE(written(head + tail, "structure.nodes[0].mass=2").anew);
  const std::string both =
      "structure.nodes=[{name=\"A\", position=[0, 0, 0], fixed=true}, {name=\"B\", position=[1, 0, 0]}, "
      "{name=\"C\", position=[2, 0, 1]}]";
  const WrittenBack list = written(custom, both);
  CHECK_FALSE(list.anew);
  CHECK(list.lost == "comments");
  CHECK(list.text.starts_with("# of nothing\n"));
}

}  // namespace write_in_place_test
