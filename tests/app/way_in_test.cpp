// SPDX-License-Identifier: BSD-3-Clause
// How a newcomer finds the way: keys, scenes to read and to begin from, help with examples.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/study/table.hpp"
#include "core/text/wrapped.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace way_in_test {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void check_width(const std::string& text) {
  for (const auto& line : lines_of(text)) {
    INFO(line);
    CHECK(characters_in(line) <= 80);
  }
}

// The words of the verbs, from the program's own help.
std::vector<std::string> verbs() {
  std::vector<std::string> names;
  for (const auto& line : lines_of(run_program({"--help"}).out))
    if (line.starts_with("  unfurl ")) names.push_back(line.substr(9, line.find_first_of(" \n", 9) - 9));
  return names;
}

std::string scene(const char* name) {
  return file_text(std::string(UNFURL_ROOT) + "/assets/scenes/" + name + ".toml");
}

}  // namespace

TEST_CASE("help is 80 columns wide and ends with examples") {
  check_width(run_program({"--help"}).out);
  const auto names = verbs();
  CHECK(names.size() >= 14);
  for (const auto& verb : names) {
    INFO(verb);
    const std::string help = run_program({"help", verb}).out;
    check_width(help);
    CHECK(contains(help, "\nexamples:\n  unfurl " + verb + " "));
  }
  check_width(run_program({"list", "keys"}).out);
  for (const char* list :
       {"structures", "methods", "figures", "constraints", "forces", "looks", "measures", "columns"})
    check_width(run_program({"list", list}).out);
}

TEST_CASE("help names the options that a verb takes and no other, and others are refused") {
  CHECK_FALSE(contains(run_program({"help", "list"}).out, "--transparent"));
  CHECK_FALSE(contains(run_program({"help", "check"}).out, "--size"));
  CHECK(contains(run_program({"help", "render"}).out, "--transparent"));
  for (const auto& words : std::vector<std::vector<std::string>>{{"check", "hoop6", "--size", "64x64"},
                                                                 {"check", "hoop6", "-o", "x"},
                                                                 {"list", "scenes", "--set", "a=1"},
                                                                 {"new", "hoop", "--json"}}) {
    const ProgramResult r = run_program(words);
    CHECK(r.code == 2);
    CHECK(contains(r.err, "has no option"));
  }
  CHECK(run_program({"check", "hoop6", "--quiet", "--threads", "2"}).code == 0);
}

TEST_CASE("one key said twice is an error") {
  const ProgramResult r =
      run_program({"render", "hoop6", "-o", "x", "--set", "render.size=[0, 0]", "--size", "64x64"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: --size and --set render.size say the same key: give one of them\n");
}

TEST_CASE("a camera may follow and be led at once") {
  for (const char* leader :
       {"render.camera_keys=[{time=0,azimuth=30}]", "render.orbit=40", "render.turntable=2"}) {
    const ProgramResult r = run_program({"check", "hoop6", "--set", "render.follow=true", "--set", leader});
    CHECK(r.code == 0);
  }
}

TEST_CASE("keys are listed by table, for people and for programs") {
  const std::string solver = run_program({"list", "keys", "solver"}).out;
  CHECK(contains(solver, "[solver]: "));
  CHECK(contains(solver, "  step                  a number > 0 s; default 0.01\n"));
  CHECK(run_program({"list", "solver"}).out == solver);
  CHECK(contains(run_program({"list", "keys", "hoop"}).out, "[structure] with kind = \"hoop\": "));
  const auto json = nlohmann::json::parse(run_program({"list", "keys", "forces", "--json"}).out);
  CHECK(json.size() > 5);
  CHECK(json[0]["header"] == "[[forces]]");
  CHECK(json[0]["keys"][0]["required"] == true);
  const ProgramResult unknown = run_program({"list", "keys", "solvr"});
  CHECK(unknown.code == 2);
  CHECK(unknown.err == "unfurl: no table of keys 'solvr'; did you mean 'solver'?\n");
  CHECK(run_program({"list", "scenes", "keys"}).code == 2);
  CHECK(contains(run_program({"list", "columns"}).out, "kinetic_energy_J"));
}

// What follows the dot of a column of an entry, or the column of a structure of its own.
TEST_CASE("every column that a scene of the library has is listed") {
  const ScratchDirectory dir;
  const std::string listed = run_program({"list", "columns"}).out;
  for (const char* name : {"hoop6_motor", "cable_ring", "reentrant_sheet", "four_bar", "mesh_reflector"}) {
    REQUIRE(run_program({"run", name, "-o", dir / name, "--set", "solver.end_time=0.01", "--quiet"}).code ==
            0);
    std::istringstream header(lines_of(file_text(dir / name + "/series.csv")).at(0));
    for (std::string column; std::getline(header, column, ',');) {
      INFO(name << ": " << column);
      const std::size_t dot = column.rfind('.');
      std::string word = dot == std::string::npos ? column : column.substr(dot);
      for (const char* axis : {"_y_N", "_z_N"})  // listed behind that of x
        if (word.ends_with(axis)) word = axis;
      CHECK(contains(listed, word));
    }
  }
}

TEST_CASE("show prints a scene as it stands, and with changes in their places") {
  CHECK(run_program({"show", "four_bar"}).out == scene("four_bar"));
  std::string changed = scene("hoop6_motor");
  const std::string was = "duration = 5.0 ", is = "duration = 7.5 ";
  changed.replace(changed.find(was), was.size(), is);
  CHECK(run_program({"show", "hoop6_motor", "--set", "constraints[0].duration=7.5"}).out == changed);
  CHECK(run_program({"show", "hoop6", "--set", "structure.units=2"}).code == 3);
  const std::string all = run_program({"show", "hoop6", "--all"}).out;
  CHECK(contains(all, "rho_inf = "));
  const ScratchDirectory dir;
  CHECK(run_program({"check", dir.write("all.toml", all)}).code == 0);
}

// What a rod leaves out is that of all rods.
TEST_CASE("in a new custom scene a rod is as the structure says") {
  const ScratchDirectory dir;
  std::string text = run_program({"new", "custom"}).out;
  const auto give = [&](const std::string& key, const std::string& value) {
    const std::size_t at = text.find("\n" + key + " = ");
    REQUIRE(at != std::string::npos);
    text.replace(at, text.find('\n', at + 1) - at, "\n" + key + " = " + value);
    CHECK(text.find("\n" + key + " = ", at + 1) == std::string::npos);  // once, of the structure
  };
  give("youngs_modulus", "7e10");
  give("strength", "1e8");
  give("rod_model", "\"elastic\"");
  CHECK(text.find("\nelastic = ") == std::string::npos);
  CHECK(run_program({"check", dir.write("new.toml", text), "--set", "structure.rods[0].area=1e-4", "--set",
                     "structure.rods[1].area=1e-4"})
            .code == 0);
}

TEST_CASE("a new scene of every kind runs") {
  const auto kinds = nlohmann::json::parse(run_program({"list", "structures", "--json"}).out);
  for (const auto& kind : kinds) {
    const std::string name = kind["name"];
    INFO(name);
    const ScratchDirectory dir;
    const std::string text = run_program({"new", name}).out;
    check_width(text);
    const auto path = dir.write("new.toml", text);
    // A tenth of a second: whether it runs, not where to.
    const ProgramResult r = run_program({"run", path, "--json", "--set", "solver.end_time=0.1"});
    INFO(r.err);
    CHECK(r.code == 0);
  }
  const ProgramResult r = run_program({"new", "hop"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: no kind of structure 'hop'; did you mean 'hoop'?\n");
}

TEST_CASE("without end_time a structure that can deploy runs until it is deployed, at most 60 s") {
  const ScratchDirectory dir;
  const auto run = [&](const std::string& structure, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"run", dir.write("s.toml", "[structure]\n" + structure), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult r = run_program(words);
    INFO(r.err);
    REQUIRE(r.code == 0);
    return nlohmann::json::parse(r.out);
  };
  const auto ring = run("kind = 'hoop'\nfold_angle = 60\n");
  CHECK(ring["status"] == "deployed");
  CHECK(ring["notes"].empty());
  const auto resting = run("kind = 'hoop'\nhinge_force = 0\n");
  CHECK(resting["final"]["t_s"] == 60.0);
  CHECK(resting["notes"][0] == "0 % deployed when end_time = 60 s was reached");
  CHECK(run("kind = 'chain'\n")["final"]["t_s"] == 1.0);
}

TEST_CASE("a run that ends early says how far it got, and is never rounded up to deployed") {
  const ProgramResult r = run_program({"run", "hoop6", "--json", "--set", "solver.end_time=4.9"});
  const auto json = nlohmann::json::parse(r.out);
  const std::string note = json["notes"][0];
  CHECK(contains(r.err, note + "\n"));
  // By the definition of the fraction, from where a hinge stands at the end: sin(fold) = (z + l2/2) / l1.
  const double sine = (json["final"]["positions_m"]["Mb0"][2].get<double>() + 0.6) / 3.0;
  const double start = std::cos(89.34053637766085 * std::acos(-1.0) / 180);
  const double fraction = (std::sqrt(1 - sine * sine) - start) / (1 - start);
  CHECK(number_of(note.substr(0, note.find(' '))) == std::floor(1000 * fraction) / 10);
  CHECK(contains(note, " % deployed when end_time = 4.9 s was reached"));
}

}  // namespace way_in_test
