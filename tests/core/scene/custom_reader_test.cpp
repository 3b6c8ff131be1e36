// SPDX-License-Identifier: BSD-3-Clause
// Custom structures from a scene and from CSV files beside it.
#include <unistd.h>
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace custom_reader_test {

namespace {

// A folder of its own for a test's files, gone with it.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("unfurl_custom_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
    return (path / name).string();
  }
};

using testing::error_of;

std::string file_error_of(const std::string& path) {
  try {
    read_scene_file(path);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

const std::string head = "[structure]\nkind = 'custom'\n";
const std::string two_nodes =
    "[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nfixed = true\n"
    "[[structure.nodes]]\nname = 'B'\nposition = [0, 0, 2]\nvelocity = [1, 0, 0]\nmass = 3\n";

}  // namespace

TEST_CASE("nodes, rods, constraints and loads are read") {
  const Scene scene =
      read_scene_text(head + two_nodes +
                          "[[structure.rods]]\nname = 'r'\nnodes = ['A', 'B']\ndensity = 2\narea = 3\n"
                          "[[structure.constraints]]\nkind = 'line'\nnodes = 'B'\ndirection = [0, 0, 1]\n"
                          "[[loads]]\nnodes = ['?']\nforce = [1, 0, 0]\n",
                      "x");
  CHECK(scene.custom.nodes[0].fixed);
  CHECK(scene.custom.nodes[1].velocity == Vec3(1, 0, 0));
  CHECK(scene.custom.nodes[1].mass == 3.0);
  CHECK_FALSE(scene.custom.rods[0].mass.has_value());
  const Structure s = build_structure(scene);
  CHECK(s.rods[0].mass == 12.0);  // 2 kg/m^3 * 3 m^2 * 2 m
  CHECK(s.constraints.size() == 2);
  CHECK(s.loads.size() == 2);
}

TEST_CASE("mistakes in a list carry the entry's place") {
  CHECK(error_of(head + two_nodes + "[[structure.rods]]\nnodes = ['A', 'b2']\nmass = 1\n") ==
        "s.toml:13:9: structure.rods[0].nodes: there is no node 'b2'; did you mean 'B'?");
  CHECK(error_of(head + two_nodes + "[[structure.rods]]\nnodes = ['A', 'B']\n") ==
        "s.toml:12:1: structure.rods[0].mass: give mass (0: a pure distance constraint), or both density and "
        "area");
  CHECK(error_of(head + two_nodes + "[[structure.rods]]\nnodes = ['A', 'B']\nmass = -2\n") ==
        "s.toml:14:8: structure.rods[0].mass: must be >= 0 kg; got -2");
  CHECK(error_of(head + two_nodes + "[[structure.nodes]]\nposition = [0, 0, 'x']\n") ==
        "s.toml:12:1: structure.nodes[2].name: is missing; must be text\n"
        "s.toml:13:12: structure.nodes[2].position: must be a list of 3 numbers in m; got a list with text");
  CHECK(error_of(head + two_nodes +
                 "[[structure.constraints]]\nkind = 'plane'\nnodes = 'B'\nnormal = [0, 0, 0]\n") ==
        "s.toml:15:10: structure.constraints[0].normal: must not be zero");
  CHECK(error_of(head + two_nodes + "[[structure.constraints]]\nkind = 'plane'\nnodes = 'B'\n") ==
        "s.toml:12:1: structure.constraints[0].normal: is missing; must be a list of 3 numbers");
  CHECK(error_of(head + two_nodes +
                 "[[structure.constraints]]\nkind = 'fixed'\nnodes = 'B'\nnormal = [0, 0, 1]\n") ==
        "s.toml:15:1: structure.constraints[0].normal: unknown key; known: kind, name, enabled, nodes");
}

TEST_CASE("a plane passes through each node's start, its normal made a unit vector") {
  for (const char* normal : {"[0, 0, 1e-200]", "[0, 0, 7]", "[0, 0, 1e200]"}) {
    const Structure s = build_structure(read_scene_text(
        head + two_nodes + "[[structure.constraints]]\nkind = 'plane'\nnodes = ['?']\nnormal = " + normal +
            "\n",
        "x"));
    REQUIRE(s.constraints.size() == 3);  // A is fixed
    CHECK(s.constraints[1].vectors[0] == Vec3(0, 0, 1));
    CHECK(s.constraints[1].value == 0);
    CHECK(s.constraints[2].value == 2);
    CHECK(s.constraints[2].name == "plane of B");
  }
}

TEST_CASE("constraints find their nodes by pattern, a literal name first") {
  const Structure s = build_structure(
      read_scene_text(head + two_nodes + "[[structure.nodes]]\nname = '*'\nposition = [1, 1, 1]\nmass = 1\n" +
                          "[[structure.constraints]]\nkind = 'fixed'\nnodes = '*'\n" +
                          "[[structure.constraints]]\nkind = 'fixed'\nnodes = '?'\n",
                      "x"));
  REQUIRE(s.constraints.size() == 1 + 1 + 3);
  CHECK(s.constraints[1].nodes == std::vector<int>{2});
  CHECK(error_of(head + two_nodes + "[[structure.constraints]]\nkind = 'fixed'\nnodes = ['X*']\n") ==
        "s.toml:14:9: structure.constraints[0].nodes: there is no node 'X*'; known: A, B");
}

TEST_CASE("a node that moves without mass is refused, one that follows others is not") {
  const std::string third = "[[structure.nodes]]\nname = 'C'\nposition = [0, 3, 1]\n";
  try {
    build_model(read_scene_text(head + two_nodes + third, "s.toml"));
    FAIL("a node without mass");
  } catch (const SceneError& error) {
    CHECK(std::string(error.what()) ==
          "s.toml:12:1: structure.nodes[2].mass: node C can move but has no mass: give it a mass, or a mass "
          "to a rod "
          "that ends there");
  }
  CHECK_NOTHROW(build_model(read_scene_text(head + two_nodes + third +
                                                "[[structure.constraints]]\nkind = 'mirror'\nnodes = ['B', "
                                                "'C']\nnormal = [0, 3, -1]\npoint = [0, 1.5, 1.5]\n",
                                            "s.toml")));
}

TEST_CASE("one wrong node does not set off messages about what refers to it") {
  CHECK(
      error_of(head + two_nodes +
               "[[structure.nodes]]\nname = 'C'\nposition = 3\n[[structure.rods]]\nnodes = ['B', "
               "'C']\nmass = 1\n") ==
      "s.toml:14:12: structure.nodes[2].position: must be a list of 3 numbers in m; got the whole number 3");
}

TEST_CASE("nodes and rods come from CSV files beside the scene") {
  const Folder folder;
  folder.write("n.csv",
               "name,x_m,y,z,mass_kg,fixed\nA,0,0,0,,true\n\"B, 2\",1e0,+0.5,-2,+3.25,false\nC,9,9,9,1,1\n");
  folder.write("r.csv", "\xEF\xBB\xBF# rods\r\na,b,mass\r\nA,\"B, 2\",1.5\r\n\"B, 2\",C,0.5\r\n");
  const auto path = folder.write("s.toml", head + "nodes_file = 'n.csv'\nrods_file = 'r.csv'\n");
  const Scene scene = read_scene_file(path);
  REQUIRE(scene.custom.nodes.size() == 3);
  CHECK(scene.custom.nodes[0].fixed);
  CHECK_FALSE(scene.custom.nodes[1].fixed);
  CHECK(scene.custom.nodes[2].fixed);
  CHECK(scene.custom.nodes[1].name == "B, 2");
  CHECK(scene.custom.nodes[1].position == Vec3(1, 0.5, -2));
  CHECK(scene.custom.nodes[1].mass == 3.25);
  REQUIRE(scene.custom.rods.size() == 2);
  CHECK(scene.custom.rods[0].mass == 1.5);
}

TEST_CASE("mistakes in CSV files carry file and line") {
  const Folder folder;
  const std::string dir = folder.path.string() + "/";
  const auto scene = folder.write("s.toml", head + "nodes_file = 'n.csv'\n");
  const auto error = [&](const std::string& csv) {
    folder.write("n.csv", csv);
    return file_error_of(scene);
  };
  CHECK(error("name,x,y,z\nA,0,0,++1\n") == dir + "n.csv:2:1: z: must be a finite number; got '++1'");
  CHECK(error("name,x,y,z\nA,0,0,+\n") == dir + "n.csv:2:1: z: must be a finite number; got '+'");
  CHECK(error("name,x,y,z\nA,0,0,one\n") == dir + "n.csv:2:1: z: must be a finite number; got 'one'");
  CHECK(error("name,x,y,z\nA,0,0,nan\n") == dir + "n.csv:2:1: z: must be a finite number; got 'nan'");
  CHECK(error("name,x,y,z\n\nA,0,0\n") == dir + "n.csv:3:1: has 3 cells; the header has 4");
  CHECK(error("name,x,y,z\n\"A\",0,0,0\n\"B,0,0,1\nC,0,0,2\n") ==
        dir + "n.csv:3:1: has a quote that is not closed");
  CHECK(error("name,x,y,z,fixed\nA,0,0,0,yes\n") ==
        dir + "n.csv:2:1: fixed: must be true or false; got 'yes'");
  CHECK(error("name,x,y\nA,0,0\n") == dir + "n.csv:1:1: column 'z' is missing");
  CHECK(error("name,x,y,z,mas\nA,0,0,0,1\n") ==
        dir + "n.csv:1:1: unknown column 'mas'; did you mean 'mass'?");
  CHECK(error("name,x,y,z,x\nA,0,0,0,1\n") == dir + "n.csv:1:1: column 'x' appears twice");
  CHECK(error("") == dir + "n.csv:1:1: is empty; the first line must name the columns");
  CHECK(error("name,x,y,z,mass\nA,0,0,0,1\nA,1,0,0,1\n") ==
        dir + "n.csv:3:1: structure.nodes[1].name: there is already a node 'A', entry 0");
  CHECK(error("name,x,y,z,mass\nA,0,0,0,-1\n") ==
        dir + "n.csv:2:1: structure.nodes[0].mass: must be >= 0 kg; got -1");
  CHECK(error("name,x,y,z\n\xFF,0,0,0\n") == dir + "n.csv:2:1: not valid UTF-8");
}

// A scene has such texts worked out, so that the scene as run could not be read again, or would say "2" as 2.
TEST_CASE("names and groups of CSV files that are expressions in a scene are refused where they stand") {
  const Folder folder;
  const std::string dir = folder.path.string() + "/";
  const auto scene = folder.write("s.toml", head + "nodes_file = 'n.csv'\nrods_file = 'r.csv'\n");
  const auto error = [&](const std::string& node, const std::string& rod, const std::string& group) {
    folder.write("n.csv", "name,x,y,z\n" + node + ",0,0,0\nB,1,0,0\n");
    folder.write("r.csv", "a,b,name,mass,group\n" + node + ",B," + rod + ",2," + group + "\n");
    return file_error_of(scene);
  };
  const std::string why = " begins with =, as expressions do; give it another name";
  for (const std::string text : {"=A", "=2", "=pi"}) {
    CHECK(error(text, "r", "g") == dir + "n.csv:2:1: structure.nodes[0].name: '" + text + "'" + why);
    CHECK(error("A", text, "g") == dir + "r.csv:2:1: structure.rods[0].name: '" + text + "'" + why);
    CHECK(error("A", "r", text) == dir + "r.csv:2:1: structure.rods[0].group: '" + text + "'" + why);
  }
  CHECK(error("E=A", "r=", "{g}") == "");
  const Scene read = read_scene_file(scene);
  const std::string text = scene_text(read);
  CHECK(scene_text(read_scene_text(text, "s.toml")) == text);
}

// What the table [[structure.rods]] refuses, a column of the same name refuses in the same words.
TEST_CASE("numbers in CSV files have the range of the keys they stand for") {
  const Folder folder;
  const std::string dir = folder.path.string() + "/";
  const std::string nodes = "name,x,y,z,fixed\nA,0,0,0,1\nB,1,0,0,0\n";
  folder.write("n.csv", nodes);
  const auto scene = folder.write("s.toml", head + "nodes_file = 'n.csv'\nrods_file = 'r.csv'\n");
  const auto error = [&](const std::string& column, const std::string& value) {
    const bool mass = column == "mass";
    folder.write("r.csv", std::string("a,b,area,youngs_modulus,") + (mass ? "mass" : "mass," + column) +
                              "\nA,B,1e-4,1e9," + (mass ? value : "1," + value) + "\n");
    const std::string said = file_error_of(scene), place = dir + "r.csv:2:1: ";
    return said.starts_with(place) ? said.substr(place.size()) : said;
  };
  const std::string segments = "structure.rods[0].segments: must be a whole number in [1, 1000]; got ";
  for (const char* wrong : {"2.5", "0", "-3", "1001"}) CHECK(error("segments", wrong) == segments + wrong);
  for (const char* wrong : {"1e30", "1e10"}) CHECK(error("segments", wrong).starts_with(segments));
  CHECK(error("mass", "-1") == "structure.rods[0].mass: must be >= 0 kg; got -1");
  CHECK(error("length", "0") == "structure.rods[0].length: must be > 0 m; got 0");
  CHECK(error("free_length", "-1").starts_with("structure.rods[0].free_length: must be > 0 m; got -1"));
  CHECK(error("second_moment", "-1") == "structure.rods[0].second_moment: must be >= 0 m^4; got -1");
  CHECK(error("strength", "0") == "structure.rods[0].strength: must be > 0 Pa; got 0");
  CHECK(error("area", "-1").find("column 'area' appears twice") != std::string::npos);
  for (const char* wrong : {"2", "0.5", "-1"})
    CHECK(error("elastic", wrong) == std::string("elastic: must be true or false; got '") + wrong + "'");
  for (const char* right : {"1", "0", "true", "false", "1.0", ""}) CHECK(error("elastic", right).empty());
  for (const char* right : {"1", "1000", "3.0", ""}) CHECK(error("segments", right).empty());
  folder.write("n.csv", "name,x,y,z,fixed\nA,0,0,0,2\nB,1,0,0,0\n");
  CHECK(file_error_of(scene).starts_with(dir + "n.csv:2:1: fixed: must be true or false; got '2'"));
}

TEST_CASE("a list that is the name of a file is told which key names files") {
  const std::string told =
      "s.toml:3:9: structure.nodes: must be an array of tables, [[structure.nodes]]; a CSV file is named by "
      "nodes_file = 'n.csv'";
  CHECK(error_of(head + "nodes = 'n.csv'").find(told) != std::string::npos);
}

TEST_CASE("files outside the scene's folder are not read") {
  const Folder folder;
  std::filesystem::create_directories(folder.path / "in");
  folder.write("n.csv", "name,x,y,z,mass\nA,0,0,0,1\n");
  std::filesystem::create_symlink(folder.path / "n.csv", folder.path / "in" / "link.csv");
  const auto error = [&](const std::string& name) {
    return file_error_of(folder.write("in/s.toml", head + "nodes_file = '" + name + "'\n"));
  };
  CHECK(error("../n.csv").find("nodes_file: must lie inside the scene's folder") != std::string::npos);
  CHECK(error("link.csv").find("nodes_file: must lie inside the scene's folder") != std::string::npos);
  CHECK(error("/etc/passwd").find("nodes_file: must be relative to the scene's folder") != std::string::npos);
  CHECK(error("none.csv").find("none.csv: No such file or directory") != std::string::npos);
  CHECK(error_of(head + "nodes_file = 'n.csv'") ==
        "s.toml:3:14: structure.nodes_file: a scene that is not a file cannot name other files");
}

TEST_CASE("what is wrong with a table over time is told by its file and row") {
  const Folder folder;
  const std::string scene = folder.write("s.toml",
                                         "[structure]\nkind = 'pendulum'\n[[forces]]\nkind = "
                                         "'load_over_time'\nnodes = ['bob']\nforce = [1, 0, 0]\n"
                                         "table = 'f.csv'\n");
  const auto told = [&](const std::string& rows) {
    const std::string file = folder.write("f.csv", "# of a test\nt,value\n" + rows),
                      error = file_error_of(scene);
    return error.starts_with(file) ? error.substr(file.size()) : error;
  };
  CHECK(told("0,0\n1,0\n1,2\n2,1\n") == "");  // a jump
  CHECK(told("0,0\n1,0\n\n0.5,1\n") == ":6:1: t: must ascend; a time may stand twice, the load jumps there");
  CHECK(told("0,0\n1,0\n1,2\n1,3\n") == ":6:1: t: must ascend; a time may stand twice, the load jumps there");
  CHECK(told("0,0\n1,x\n") == ":4:1: value: must be a finite number; got 'x'");
  CHECK(told("0,0\n") == scene + ":7:9: forces[0].table: must have at least two rows");
}

TEST_CASE("a table over time with other columns is told by them alone") {
  const Folder folder;
  const std::string scene =
      folder.write("s.toml",
                   "[structure]\nkind = 'pendulum'\n[[constraints]]\nkind = 'angle'\nname = 'motor'\n"
                   "nodes = ['O', 'bob']\nmotion = 'table'\ntable = 'f.csv'\n");
  const auto told = [&](const std::string& text) {
    folder.write("f.csv", text);
    return file_error_of(scene);
  };
  const std::string columns = told("t_s,value_deg\n0,0\n1,1\n");
  CHECK(columns.find("unknown column 'value_deg'") != std::string::npos);
  for (const char* wrong : {"two rows", "times"}) CHECK(columns.find(wrong) == std::string::npos);
  const std::string one = told("t,value\n0,0\n");
  CHECK(one.find("constraints[0].table: must have at least two rows") != std::string::npos);
  CHECK(one.find("times") == std::string::npos);
}

TEST_CASE("keys into a list of a CSV file are told where its entries are") {
  const Folder folder;
  folder.write("n.csv", "name,x,y,z,fixed,mass\nA,0,0,0,1,0\nB,1,0,0,0,1\n");
  folder.write("r.csv", "a,b,mass\nA,B,1\n");
  const std::string scene = folder.write("s.toml", head + "nodes_file = 'n.csv'\nrods_file = 'r.csv'\n");
  const auto told = [&](const std::string& change) -> std::string {
    try {
      read_scene_file(scene, {change});
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  const std::string nodes = "those of nodes_file = 'n.csv' are changed in that file",
                    rods = "those of rods_file = 'r.csv' are changed in that file";
  for (const char* change :
       {"structure.nodes.B.mass=2", "structure.nodes[0].mass=2", "structure.nodes[1].mass=2"}) {
    INFO(change);
    CHECK_THAT(told(change), Catch::EndsWith(nodes));
  }
  for (const char* change :
       {"structure.rods.A-B.mass=2", "structure.rods[0].mass=2", "structure.rods[1].mass=2"}) {
    INFO(change);
    CHECK_THAT(told(change), Catch::EndsWith(rods));
  }
  // One more beside those of the file is no mistake.
  CHECK(told("structure.nodes[0]={name='C', position=[2, 0, 0], fixed=true}") == "");
}

}  // namespace custom_reader_test
