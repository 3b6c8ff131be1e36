// SPDX-License-Identifier: BSD-3-Clause
// What an earlier run left in the directory of a new one: whole until that takes its place, then gone.
#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <thread>

#include "tests/app/run_program.hpp"

namespace unfurl::earlier_results_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Long enough to be stopped, with a film of few frames.
Words long_one(const std::string& verb, const std::string& out) {
  return {verb,     "double_pendulum",      "--set", "solver.end_time=20",
          "--set",  "solver.step=0.0002",   "-o",    out,
          "--set",  "render.size=[96, 64]", "--set", "render.fps=1",
          "--quiet"};
}

// A signal while it simulates: it has claimed its film and takes a second more.
int stopped(const Words& words, const std::string& when_there, double after_s = 0.05) {
  return run_program(words, {.interrupt_after_s = after_s, .first_wait_for = when_there}).code;
}

}  // namespace

// The run as a whole has 100001 states, the stopped one fewer: whatever it exported ends early.
TEST_CASE("what a stopped run exported goes when the motion is run to its end") {
  const ScratchDirectory dir;
  for (const std::string second : {"run", "render"}) {
    const std::string out = dir / second;
    double after = 0.05;  // later where it had no state yet: on a busy machine
    for (int tries = 0; tries < 5 && !fs::exists(out + "/npy"); ++tries, after *= 2) {
      fs::remove_all(out);
      REQUIRE(stopped(long_one("render", out) + Words{"--export", "npy,gltf"}, out + "/film.json", after) ==
              130);
    }
    REQUIRE(fs::exists(out + "/npy"));
    REQUIRE(fs::exists(out + "/animation.glb"));
    REQUIRE(run_program(long_one(second, out) + (second == "run" ? Words{} : Words{"--dpi", "60"})).code ==
            0);
    CHECK_FALSE(fs::exists(out + "/npy"));
    CHECK_FALSE(fs::exists(out + "/animation.glb"));
    CHECK(fs::exists(out + "/film.json"));  // which is of this very motion
    CHECK_FALSE(fs::exists(out + "/unfinished"));
    CHECK(run_program({"verify", out}).code == 0);
  }
  // What a film's run exported to its end is of the same motion, and stays.
  const std::string film = dir / "render";
  REQUIRE(run_program(long_one("run", film) + Words{"--export", "npy"}).code == 0);
  const std::string times = file_text(film + "/npy/t_s.npy");
  REQUIRE(run_program(long_one("run", film)).code == 0);
  CHECK((file_text(film + "/npy/t_s.npy") == times));
  CHECK(fs::exists(film + "/report.html"));
}

// Looked for again and again while the new ones come: a second signal or a kill may fall into any moment.
TEST_CASE("the tables of an earlier run are there until new ones take their places") {
  const ScratchDirectory dir;
  const std::set<std::string> tables{"series.csv", "trajectory.csv", "rod_forces.csv"};
  std::set<std::string> all = tables;
  all.insert({"scene.toml", "summary.json"});
  // Many files to be removed; a run of one part and one of many, whose summary goes for the moment of the
  // change.
  const Words many{"--export", "vtk", "--set", "solver.step=0.005"};
  for (const auto& [second, always] :
       {std::pair{Words{"--set", "solver.step=0.004"}, all}, std::pair{Words{"--export", "csv"}, all},
        std::pair{Words{"--set", "solver.step=0.0005", "--checkpoint", "0"}, tables}}) {
    const std::string out = dir / "out";
    const Words run{"run", "hoop6", "-o", out, "--quiet"};
    REQUIRE(run_program(run + many).code == 0);
    const std::string before = file_text(out + "/series.csv");
    std::atomic<bool> ended{false};
    std::set<std::string> missed;
    std::thread watch([&missed, &ended, &always = always, &out] {
      while (!ended)
        for (const std::string& name : always)
          if (!fs::exists(out + "/" + name)) missed.insert(name);
    });
    const int code = run_program(run + second).code;
    ended = true;
    watch.join();
    CHECK(code == 0);
    CHECK(missed.empty());
    CHECK(file_text(out + "/series.csv") != before);
    CHECK_FALSE(fs::exists(out + "/vtk"));
    CHECK_FALSE(fs::exists(out + "/unfinished"));
    CHECK(run_program({"verify", out}).code == 0);
  }
}

}  // namespace unfurl::earlier_results_test
