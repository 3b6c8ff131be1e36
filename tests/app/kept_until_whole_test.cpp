// SPDX-License-Identifier: BSD-3-Clause
// --force: what an earlier command left stays until the first new result is whole.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>

#include "tests/app/run_program.hpp"

namespace unfurl::kept_until_whole_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// All files and their bytes but the list of what was written, which may grow.
std::map<std::string, std::string> contents(const std::string& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != ".unfurl")
      found[entry.path().lexically_relative(folder).string()] = file_text(entry.path().string());
  return found;
}

// One scene and another one, whose scene.toml alone has some 20 kB by its title.
struct Scenes {
  ScratchDirectory dir;
  std::string out = dir / "out";
  std::string longer =
      dir.write("longer.toml",
                "title = '" + std::string(20000, 'x') +
                    "'\n[structure]\nkind = 'pendulum'\nangle = 35\n[solver]\nstep = 0.05\nend_time = 0.1\n");

  Words of(const std::string& verb, const std::string& scene, const Words& more) const {
    return with(
        {verb, scene, "--quiet", "--set", "solver.end_time=0.1", "--set", "solver.step=0.05", "-o", out},
        more);
  }
};

const Words small{"--size", "48x32", "--fps", "10", "--set", "render.mp4=false", "--dpi", "40"};
const Words swept{"--vary", "structure.angle=10,20", "--measure", "energy", "--dpi", "40"};
const Words studied{"--steps", "0.025:0.01", "--methods", "rk4", "--repeats", "1", "--dpi", "40"};

}  // namespace

// No file may be larger than 12 kB, less than the new scene.toml and more than the list of what was written:
// as on a full disk. The same with room replaces all.
TEST_CASE("a command that finds the disk full leaves what its --force would replace") {
  const std::pair<std::string, Words> verbs[] = {
      {"render", small}, {"sweep", swept}, {"study", studied}, {"render", with(small, {"--mode", "1"})}};
  for (const auto& [verb, words] : verbs) {
    const Scenes s;
    INFO(verb);
    REQUIRE(run_program(s.of(verb, "pendulum", words)).code == 0);
    const auto before = contents(s.out);
    CHECK(before.size() > 4);
    const Words anew = s.of(verb, s.longer, with(words, {"--force"}));
    const ProgramResult full = run_program(anew, {.largest_file = 12000});
    INFO(full.err);
    CHECK(full.code == 5);
    CHECK(full.err.find("file too large") != std::string::npos);
    CHECK((contents(s.out) == before));
    CHECK(run_program({"verify", s.out}).code == 0);
    const ProgramResult whole = run_program(anew);
    INFO(whole.err);
    CHECK(whole.code == 0);
    CHECK(file_text(s.out + "/scene.toml").find("xxxx") != std::string::npos);
    CHECK(run_program({"verify", s.out}).code == 0);
  }
}

// A point of 50 million steps has no end within the time.
TEST_CASE("a study that is ended before its first result leaves what its --force would replace") {
  const Words endless{"--set", "solver.end_time=50", "--set",  "solver.step=1e-6",
                      "--set", "solver.model=full",  "--force"};
  for (const auto& [verb, words] : {std::pair<std::string, Words>{"sweep", swept}, {"study", studied}}) {
    const Scenes s;
    INFO(verb);
    REQUIRE(run_program(s.of(verb, "pendulum", words)).code == 0);
    const auto before = contents(s.out);
    Words anew = {verb, "pendulum", "--quiet", "-o", s.out};
    anew = with(with(anew, words), endless);
    const ProgramResult ended = run_program(anew, {.interrupt_after_s = 0.7});
    INFO(ended.err);
    CHECK(ended.code == 130);
    CHECK((contents(s.out) == before));
  }
}

// Of two points the second has no end: the first replaces all that was there.
TEST_CASE("the first point of a sweep with --force replaces an earlier sweep and is kept") {
  const Scenes s;
  REQUIRE(run_program(s.of("sweep", "pendulum", swept)).code == 0);
  const Words anew{"sweep",     "pendulum",
                   "--vary",    "solver.step=0.05,1e-6",
                   "--measure", "energy",
                   "--set",     "solver.end_time=50",
                   "--set",     "solver.model=full",
                   "--dpi",     "40",
                   "--quiet",   "--threads",
                   "1",         "--force",
                   "-o",        s.out};
  const ProgramResult ended = run_program(anew, {.interrupt_after_s = 1.5});
  INFO(ended.err);
  CHECK(ended.code == 130);
  const std::string table = file_text(s.out + "/sweep.csv");
  INFO(table);
  CHECK(table.starts_with("solver.step,outcome,energy_J\n0.05,"));
  CHECK(std::count(table.begin(), table.end(), '\n') == 2);
  CHECK(file_text(s.out + "/scene.toml").starts_with("# A sweep over solver.step"));
}

// A table that was changed by hand since is no result of ours.
TEST_CASE("a table that was edited is kept beside that of a sweep with --force") {
  const Scenes s;
  fs::create_directories(s.out);
  s.dir.write("out/sweep.csv", "mine");
  const ProgramResult r = run_program(s.of("sweep", "pendulum", with(swept, {"--force"})));
  INFO(r.err);
  CHECK(r.code == 0);
  CHECK(file_text(s.out + "/sweep.csv.kept-1") == "mine");
  CHECK(file_text(s.out + "/sweep.csv").starts_with("structure.angle,outcome"));
}

}  // namespace unfurl::kept_until_whole_test
