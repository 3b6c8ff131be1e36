// SPDX-License-Identifier: BSD-3-Clause
// unfurl import: from another program's file to a scene that is checked and run as it is.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace import_command_test {

namespace {

// Two parallelograms that fold at the edge between them.
const std::string two_plates =
    "{\"vertices_coords\": [[0, 0, 0], [0.3, 1.1, 0], [0.9, 0, 0.5], [1.2, 1.1, 0.5], [-0.8, 0.1, 0.6], "
    "[-0.5, 1.2, 0.6]],\n\"edges_vertices\": [[0, 1]], \"edges_assignment\": [\"V\"],\n"
    "\"faces_vertices\": [[0, 2, 3, 1], [0, 1, 5, 4]]}\n";

ProgramResult refused(const std::vector<std::string>& words, int code) {
  const ProgramResult r = run_program(words);
  INFO(r.err);
  CHECK(r.code == code);
  CHECK(r.out == "");
  return r;
}

}  // namespace

TEST_CASE("a scene that import writes is checked and run as it is") {
  const ScratchDirectory dir;
  const std::string file = dir.write("plates.fold", two_plates), scene = dir / "plates.toml";
  const ProgramResult made = run_program({"import", file, "-o", scene});
  INFO(made.err);
  REQUIRE(made.code == 0);
  const ProgramResult check = run_program({"check", scene, "--json"});
  REQUIRE(check.code == 0);
  const auto json = nlohmann::json::parse(check.out);
  CHECK(json["degrees_of_freedom"] == 1);
  CHECK(json["redundant"].empty());
  CHECK(run_program({"run", scene, "-o", dir / "run"}).code == 0);

  // What a person has changed in it is not written over.
  CHECK(refused({"import", file, "-o", scene}, 5).err ==
        "unfurl: " + scene + ": is there already; --force writes over it\n");
  const ProgramResult set =
      run_program({"import", file, "-o", scene, "--force", "--set", "variables.density=2700", "--quiet"});
  CHECK(set.code == 0);
  CHECK(set.err == "");
  CHECK(file_text(scene).find("density = 2700") != std::string::npos);
  // A value has its place by the node's name, too, and the rest of the file stays as it was.
  REQUIRE(run_program({"import", file, "-o", scene, "--force", "--set", "structure.nodes.V3.mass=2"}).err ==
          made.err);
  const std::string text = file_text(scene), plain = run_program({"import", file}).out;
  CHECK(text.size() == plain.size() + std::string("mass = 2\n").size());
  CHECK(run_program({"check", scene, "--set", "variables.density=2700"}).code == 0);
  // So has a component of a vector that it did not have.
  const ProgramResult moves = run_program({"import", file, "--set", "structure.nodes.V3.velocity[2]=1"});
  CHECK(moves.out.starts_with("# Made by"));
  CHECK(moves.out.size() == plain.size() + std::string("velocity = [0.0, 0.0, 1]\n").size());
  CHECK(run_program({"import", file}).out.starts_with("# Made by `unfurl import` of 'plates.fold': 6 nodes"));
}

TEST_CASE("import says what it reads and what it cannot") {
  const ScratchDirectory dir;
  const std::string nodes = dir.write("n.csv", "0,0,0\n1,0,0\n0,1,0\n"), none = dir / "none.fold";
  CHECK(refused({"import", "mesh.stl"}, 2).err ==
        "unfurl: import reads files that end in .fold, .obj or .csv; got 'mesh.stl'\n");
  CHECK(refused({"import", nodes}, 2).err ==
        "unfurl: two CSV files make a scene: unfurl import NODES.csv RODS.csv\n");
  CHECK(refused({"import", none}, 5).err == "unfurl: cannot read " + none + ": No such file or directory\n");
  const std::string cut = dir.write("cut.fold", two_plates.substr(0, 70));
  CHECK(refused({"import", cut, "-o", dir / "cut.toml"}, 3).err.starts_with(cut + ":1:71: not JSON: "));
  CHECK_FALSE(std::filesystem::exists(dir / "cut.toml"));
  // Names that no file can have, and what a file would take the place of.
  const std::string plates = dir.write("plates.fold", two_plates), pipe = dir / "pipe",
                    long_name = std::string(300, 'a') + ".toml";
  CHECK(refused({"import", plates, "-o", dir / long_name}, 5).err.find("the name has 305 bytes") !=
        std::string::npos);
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const bool force : {false, true}) {
    std::vector<std::string> words = {"import", plates, "-o", pipe};
    if (force) words.emplace_back("--force");
    CHECK(refused(words, 5).err ==
          "unfurl: " + pipe +
              ": is a device, a pipe or a socket, which no file replaces; name another one\n");
    words[3] = dir / "";
    CHECK(refused(words, 5).err == "unfurl: " + words[3] + ": is a directory\n");
  }
  CHECK(std::filesystem::is_fifo(pipe));
  // Links to such: as /dev/stdout is one, and by another extension than what it leads to.
  for (const char* to : {"/dev/null", "/proc/self/fd/1", "pipe"}) {
    const std::string link = dir / "link.toml";
    std::filesystem::create_symlink(to, link);
    CHECK(refused({"import", plates, "-o", link, "--force"}, 5).err.find("which no file replaces") !=
          std::string::npos);
    CHECK(std::filesystem::read_symlink(link) == to);
    std::filesystem::remove(link);
  }
}

}  // namespace import_command_test
