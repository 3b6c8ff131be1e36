// SPDX-License-Identifier: BSD-3-Clause
// --join: any number of workers in one directory, killed and stopped as it comes.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace join_test {

namespace {

const std::vector<std::string> sweep = {"sweep",     "hoop6_sector",
                                        "--vary",    "structure.fold_angle=30:85:20",
                                        "--vary",    "structure.hinge_force=100:300:10",
                                        "--measure", "deploy_time,max:kinetic_energy_J",
                                        "--quiet"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// How often each line but the first of the files in a folder is there.
std::map<std::string, int> lines_in(const fs::path& folder) {
  std::map<std::string, int> count;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    std::istringstream text(file_text(entry.path().string()));
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) ++count[line];
  }
  return count;
}

}  // namespace

TEST_CASE(
    "eight workers, three killed and one stopped past its lease, compute every point to the bytes of one") {
  const ScratchDirectory dir;
  REQUIRE(run_program(sweep + std::vector<std::string>{"-o", dir / "one"}).code == 0);
  std::string words;
  for (const auto& word : sweep) words += "'" + word + "' ";
  // The 2nd, 5th and 7th are killed at three moments, the 3rd sleeps for three leases; the others wait for
  // none of them longer than a lease.
  const std::string script = dir.write("workers.sh", "cd '" + dir / "" + "'\n" + R"(
for i in 1 2 3 4 5 6 7 8; do
  ")" UNFURL_PROGRAM R"(" )" + words + R"( --threads 1 -o many --join --lease 1 2>log$i &
  eval p$i=$!
done
sleep 0.2; kill -STOP $p3; kill -9 $p2
sleep 0.2; kill -9 $p5
sleep 0.3; kill -9 $p7
sleep 3; kill -CONT $p3
code=0
for p in $p1 $p3 $p4 $p6 $p8; do wait $p || code=$?; done
exit $code
)");
  CHECK(std::system(("sh '" + script + "' 2>/dev/null").c_str()) == 0);
  CHECK(file_text(dir / "many/sweep.csv") == file_text(dir / "one/sweep.csv"));
  CHECK(fs::exists(dir / "many/sweep.md"));
  const auto lines = lines_in(dir / "many/join");
  CHECK(lines.size() == 200);
  // What a killed worker had begun is computed again, a piece of one point at a time here, and what the
  // stopped one had: nothing else is computed twice.
  int twice = 0;
  for (const auto& [line, count] : lines) twice += count - 1;
  CHECK(twice <= 4);
}

TEST_CASE("a directory of a --join goes on, and holds one sweep") {
  const ScratchDirectory dir;
  const auto joined = sweep + std::vector<std::string>{"--join", "-o", dir / "out"};
  const ProgramResult begun = run_program(joined, {.interrupt_after_s = 0.3});
  CHECK((begun.code == 130 || begun.code == 0));
  CHECK(run_program(joined).code == 0);
  const std::string points = file_text(dir / "out/sweep.csv");
  CHECK(std::count(points.begin(), points.end(), '\n') == 201);
  CHECK(run_program({"verify", dir / "out"}).code == 0);
  const ProgramResult other = run_program(joined + std::vector<std::string>{"--set", "solver.end_time=7.5"});
  CHECK(other.code == 5);
  CHECK(other.err.find("holds results of another scene") != std::string::npos);
  const ProgramResult anew = run_program(joined + std::vector<std::string>{"--force"});
  CHECK(anew.code == 2);
  CHECK(anew.err.find("--force could remove what other workers") != std::string::npos);
  CHECK(run_program(joined + std::vector<std::string>{"--shard", "1/2"}).code == 2);
}

TEST_CASE("studies and films are shared like a sweep") {
  const ScratchDirectory dir;
  const std::vector<std::vector<std::string>> commands = {
      {"study", "double_pendulum", "--set", "solver.end_time=0.4", "--steps", "0.05:0.01", "--repeats", "1",
       "--methods", "dvm,rk4", "--dpi", "60", "--threads", "1", "--quiet"},
      {"render", "double_pendulum", "--set", "solver.end_time=0.4", "--size", "96x64", "--fps", "30", "--dpi",
       "60", "--threads", "1", "--quiet"}};
  const char* results[] = {"study.md", "animation.webp"};
  for (std::size_t i = 0; i < commands.size(); ++i) {
    std::string words;
    for (const auto& word : commands[i]) words += "'" + word + "' ";
    const std::string out = "out" + std::to_string(i);
    const std::string command =
        std::string("\"" UNFURL_PROGRAM "\" ") + words + " -o '" + dir / out + "' --join --lease 5";
    INFO(command);
    CHECK(std::system(("( " + command + " ) & p=$!; ( " + command + " ) && wait $p").c_str()) == 0);
    CHECK(fs::exists(dir / (out + "/" + results[i])));
    for (const auto& [line, count] : lines_in(dir / (out + "/join"))) {
      INFO(line);
      CHECK(count == 1);
    }
    CHECK(run_program({"verify", dir / out}).code == 0);
    fs::remove_all(dir / (out + "/join"));  // when all have ended
    CHECK(run_program({"verify", dir / out}).code == 0);
    fs::remove(dir / (out + "/" + results[i]));
    CHECK(run_program({"verify", dir / out}).code == 7);
  }
  REQUIRE(run_program(commands[1] + std::vector<std::string>{"-o", dir / "out1"}).code == 0);
  const ProgramResult alone = run_program(commands[1] + std::vector<std::string>{"-o", dir / "alone"});
  CHECK(alone.code == 0);
  for (const char* name :
       {"frames/frame_00000.png", "frames/frame_00011.png", "animation.webp", "animation.gif"})
    CHECK(file_text(dir / (std::string("out1/") + name)) == file_text(dir / (std::string("alone/") + name)));
}

TEST_CASE("results whose writer died are written by who waits for them") {
  const ScratchDirectory dir;
  const std::vector<std::string> joined = {"sweep",     "pendulum",
                                           "--vary",    "solver.end_time=0.1,0.2",
                                           "--measure", "max:kinetic_energy_J",
                                           "--dpi",     "40",
                                           "--join",    "-o",
                                           dir / "out"};
  REQUIRE(run_program(joined).code == 0);
  const std::string written = file_text(dir / "out/sweep.md");
  REQUIRE(fs::remove(dir / "out/sweep.md"));
  // As a worker leaves it that is killed while it writes: a lease that was renewed a moment ago.
  dir.write("out/join/results.1.lease", "somebody\n");
  const ProgramResult other = run_program(joined + std::vector<std::string>{"--lease", "0.5"});
  CHECK(other.code == 0);
  CHECK(other.err.find("another worker writes the results") != std::string::npos);
  CHECK(file_text(dir / "out/sweep.md") == written);
  // One that lives longer than this one waits, and then says that it has finished.
  REQUIRE(fs::remove(dir / "out/sweep.md"));
  dir.write("out/join/results.3.lease", "somebody\n");
  std::string words;
  for (const auto& word : joined) words += "'" + word + "' ";
  const std::string command = "\"" UNFURL_PROGRAM "\" " + words + " & p=$!; sleep 1; kill -0 $p && cd '" +
                              dir / "out/join" + "' && echo > results.3.done && wait $p";
  CHECK(std::system(("( " + command + " ) 2>/dev/null").c_str()) == 0);
  CHECK_FALSE(fs::exists(dir / "out/sweep.md"));  // it was the other's to write
}

// Whoever writes the results, each worker of a script tells them, as one that works alone does: numbers of
// sweeps follow from the scene, what a film's summary says from its file.
TEST_CASE("a worker that leaves the results to another one tells them as JSON all the same") {
  const ScratchDirectory dir;
  const std::vector<std::vector<std::string>> commands = {
      {"sweep", "pendulum", "--vary", "solver.end_time=0.1,0.2", "--measure", "max:kinetic_energy_J", "--dpi",
       "40"},
      {"study", "pendulum", "--set", "solver.end_time=0.2", "--steps", "0.05:0.025", "--repeats", "1",
       "--methods", "rk4", "--dpi", "40"},
      {"render", "pendulum", "--set", "solver.end_time=0.1", "--size", "64x48", "--fps", "10", "--dpi", "40",
       "--set", "render.gif=false", "--set", "render.mp4=false"}};
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::string out = dir / ("out" + std::to_string(i));
    const auto joined = commands[i] + std::vector<std::string>{"--quiet", "--json", "--join", "-o", out};
    INFO(joined.front());
    const ProgramResult first = run_program(joined);
    REQUIRE(first.code == 0);
    REQUIRE(first.out.find("{") == 0);
    // Another worker is about to write them again, and has soon.
    dir.write("out" + std::to_string(i) + "/join/results.1.lease", "somebody\n");
    std::string words;
    for (const auto& word : joined) words += "'" + word + "' ";
    const std::string told = dir / ("told" + std::to_string(i));
    const std::string command = "\"" UNFURL_PROGRAM "\" " + words + " > '" + told +
                                "' & p=$!; sleep 1.5; kill -0 $p && echo > '" + out +
                                "/join/results.1.done' && wait $p";
    CHECK(std::system(("( " + command + " ) 2>/dev/null").c_str()) == 0);
    CHECK(file_text(told) == first.out);
  }
}

}  // namespace join_test
