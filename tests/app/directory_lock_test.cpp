// SPDX-License-Identifier: BSD-3-Clause
// Two programs and one directory.
#include "app/output/directory_lock.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>

#include "core/export/atomic_file.hpp"
#include "core/study/journal.hpp"
#include "tests/app/run_program.hpp"

namespace unfurl::directory_lock_test {

namespace {

using Use = DirectoryLock::Use;

std::string refusal(const std::string& directory) {
  return "unfurl: " + directory +
         ": another unfurl is writing into it; wait until it has finished, or use another -o\n";
}

}  // namespace

TEST_CASE("a directory is held by one, or shared by those who may") {
  const ScratchDirectory dir;
  std::filesystem::create_directories(dir / "out");
  std::optional<DirectoryLock> first(std::in_place, dir / "out", Use::shareable);
  CHECK(first->alone());
  CHECK_THROWS_AS(DirectoryLock(dir / "out", Use::shareable), FileError);
  first->share();
  CHECK_FALSE(DirectoryLock(dir / "out", Use::shareable).alone());
  CHECK_THROWS_AS(DirectoryLock(dir / "out", Use::alone), FileError);
  first.reset();
  CHECK(DirectoryLock(dir / "out", Use::alone).alone());
}

TEST_CASE("verbs leave a directory alone where another is at work, whatever --force says") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  std::filesystem::create_directories(out);
  const DirectoryLock held(out, Use::alone);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", "pendulum", "-o", out},
                                                {"render", "pendulum", "-o", out, "--force"},
                                                {"study", "pendulum", "-o", out, "--force"},
                                                {"sweep", "pendulum", "--vary", "solver.step=0.1,0.2",
                                                 "--measure", "energy", "--shard", "1/2", "-o", out}}) {
    const ProgramResult r = run_program(words);
    INFO(words.front());
    CHECK(r.code == 5);
    CHECK(r.err == refusal(out));
  }
  for (const auto& entry : std::filesystem::directory_iterator(out))
    CHECK(entry.path().filename() == ".unfurl");  // nothing but the mark that it is ours
}

TEST_CASE("a share of a sweep is computed by one program, and --force does not take it from that") {
  const ScratchDirectory dir;
  const std::string out = dir / "out", points = out + "/sweep_1_of_2.csv";
  std::vector<std::string> words{"sweep",     "pendulum", "--vary",  "solver.step=0.05,0.1",
                                 "--measure", "energy",   "--set",   "solver.end_time=0.2",
                                 "--shard",   "1/2",      "--quiet", "-o",
                                 out};
  REQUIRE(run_program(words).code == 0);
  const std::string right = file_text(points);
  {
    const Journal at_work(points, {"solver.step", "outcome", "energy_J"}, 1);
    for (int twice = 0; twice < 2; ++twice) {
      const ProgramResult r = run_program(words);
      CHECK(r.code == 5);
      CHECK(r.err ==
            "unfurl: " + points +
                ": another unfurl is adding results to it; wait until it has finished, or use another -o\n");
      words.push_back("--force");
    }
    CHECK(file_text(points) == right);
  }
  CHECK(run_program(words).code == 0);
  CHECK(file_text(points) == right);
}

TEST_CASE("who draws the same film may join, who draws another may not") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  const auto film = [&](const char* scene, const char* frames) {
    return std::vector<std::string>{"render",   scene,   "--set", "solver.end_time=0.1",
                                    "--size",   "64x48", "--fps", "20",
                                    "--frames", frames,  "-o",    out,
                                    "--quiet",  "--dpi", "60",    "--force"};
  };
  REQUIRE(run_program(film("pendulum", "0:1")).code == 0);
  DirectoryLock drawing(out, Use::shareable);
  drawing.share();
  CHECK(run_program(film("pendulum", "1:2")).code == 0);
  const ProgramResult other = run_program(film("four_bar", "1:2"));
  CHECK(other.code == 5);
  CHECK(other.err == "unfurl: " + out + ": another unfurl is writing another film into it; use another -o\n");
}

}  // namespace unfurl::directory_lock_test
