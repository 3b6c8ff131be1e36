// SPDX-License-Identifier: BSD-3-Clause
// Every built-in scene through the verbs that look at a structure: an answer or one sentence of refusal, and
// no number that is none. What the answers are worth is said by the tests of what they are made of.
#include <catch2/catch.hpp>
#include <regex>
#include <sstream>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace every_scene_test {

namespace {

std::vector<std::string> scenes() {
  std::istringstream lines(run_program({"list", "scenes"}).out);
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line[0] != ' ') names.push_back(line.substr(0, line.find(' ')));
  REQUIRE(names.size() >= 20);
  return names;
}

// The verb with each scene and what follows; 3 where it says that the scene has none of what was asked for.
void with_each(const std::string& verb, const std::vector<std::string>& words,
               const std::string& refusal = "") {
  static const std::regex no_number("(^|[^a-z_])-?nan([^a-z_]|$)");
  int answers = 0;
  for (const std::string& scene : scenes()) {
    std::vector<std::string> command{verb, scene};
    command.insert(command.end(), words.begin(), words.end());
    const ProgramResult result = run_program(command);
    INFO(verb << " " << scene << ": " << result.code << "\n" << result.out << result.err);
    if (result.code != 0) {
      CHECK(result.code == 3);
      CHECK(!refusal.empty());
      CHECK(result.err.find(refusal) != std::string::npos);
      continue;
    }
    ++answers;
    CHECK_FALSE(std::regex_search(result.out + result.err, no_number));
  }
  CHECK(answers >= 5);
}

}  // namespace

TEST_CASE("every scene is checked") {
  with_each("check", {"--json"});  // its words are printed of the same numbers
}

TEST_CASE("every scene has modes, or nothing that is free to move") {
  with_each("modes", {});
  with_each("modes", {"--at", "end", "--set", "solver.end_time=0.02", "--json"});
}

TEST_CASE("every scene has margins, or a reason why not") {
  with_each("margin", {"--stuck"}, ": no margin: ");
}

TEST_CASE("every scene runs, by each model and to a tolerance") {
  const ScratchDirectory dir;
  const std::vector<std::string> run{"-o", dir / "run", "--force", "--set", "solver.end_time=0.05"};
  for (const char* more :
       {"--set=solver.model=auto", "--set=solver.method=rk4", "--tolerance=1e-4", "--export=html,gltf"}) {
    auto words = run;
    words.push_back(more);
    with_each("run", words);
  }
}

TEST_CASE("every scene has its pictures and figures") {
  const ScratchDirectory dir;
  with_each("render", {"-o", dir / "film", "--force", "--set", "solver.end_time=0.05", "--size", "160x90",
                       "--frames", "0:1", "--dpi", "60", "--quiet"});
}

TEST_CASE("every scene has a frequency to sweep, or none") {
  const ScratchDirectory dir;
  with_each("sweep", {"--vary", "solver.end_time=0.01:0.02:2", "--measure", "frequency,peak_rod_force,energy",
                      "-o", dir / "sweep", "--force", "--dpi", "60", "--quiet"});
}

}  // namespace every_scene_test
