// SPDX-License-Identifier: BSD-3-Clause
// `unfurl run` of long motions: killed at any moment it goes on to the same bytes, in memory that does not
// grow.
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/run_program.hpp"

namespace unfurl::unfinished_run_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::ordered_json;

// A mass that bounces on a floor until it rests, one on a spring that rubs, and a hinge that a motor turns.
const std::string everything = R"(
[structure]
kind = "custom"
nodes = [
  {name = "A", position = [0, 0, 0.7], mass = 2},
  {name = "O", position = [3, 0, 0], fixed = true},
  {name = "B", position = [5.495, 0, 0], mass = 1},
  {name = "P", position = [0, 5, 0], fixed = true},
  {name = "Q", position = [1, 5, 0], fixed = true},
  {name = "C", position = [0, 6.3, 0]}]
rods = [{name = "arm", nodes = ["P", "C"], mass = 3}]
[[constraints]]
kind = "coordinate_stop"
name = "floor"
nodes = ["A"]
direction = [0, 0, 1]
min = 0.1
restitution = 0.7
[[constraints]]
kind = "plane"
nodes = ["B", "C"]
normal = [0, 0, 1]
[[forces]]
kind = "spring"
nodes = ["O", "B"]
stiffness = 100
free_length = 2
[[forces]]
kind = "friction"
name = "pad"
nodes = ["B"]
direction = [1, 0, 0]
kinetic = 1
[[forces]]
kind = "friction"
name = "hinge"
nodes = ["Q", "P", "C"]
axis = [0, 0, 1]
kinetic = 0.2
[[loads]]
nodes = ["C"]
force = [0.9, 0.3, 0]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
stages = 3
step = 0.0013
end_time = 30
)";

Words run_of(const std::string& scene, const std::string& out, const Words& changes) {
  Words words{"run", scene, "-o", out, "--checkpoint", "0", "--quiet"};
  for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
  return words;
}

// But for what no two runs share.
std::string summary_of(const std::string& folder) {
  Json json = Json::parse(file_text(folder + "/summary.json"));
  for (const char* key : {"command", "wall_s"}) json.erase(key);
  json["solver"].erase("cpu_s");
  return json.dump(1);
}

void check_same(const std::string& a, const std::string& b) {
  for (const char* name : {"series.csv", "trajectory.csv", "rod_forces.csv", "scene.toml"}) {
    CAPTURE(name);
    CHECK((file_text(a + "/" + name) == file_text(b + "/" + name)));
  }
  CHECK(summary_of(a) == summary_of(b));
}

}  // namespace

TEST_CASE("a run that is killed goes on from its checkpoint to the same bytes") {
  const ScratchDirectory dir;
  const std::string scene = dir.write("everything.toml", everything);
  // The names of scenes; none: the one above.
  const auto [given, changes] =
      GENERATE(std::pair<std::string, Words>{"", {}},
               std::pair<std::string, Words>{"", {"solver.adaptive=true", "solver.step=0.004"}},
               std::pair<std::string, Words>{"hoop6", {"solver.step=0.0008", "solver.at_deployed=latch"}},
               std::pair<std::string, Words>{"hoop6_motor", {"solver.step=0.0013"}});
  const std::string name = given.empty() ? scene : given;
  CAPTURE(name, changes);
  const std::string whole = dir / "whole", killed = dir / "killed";
  REQUIRE(run_program(run_of(name, whole, changes)).code == 0);
  CHECK_FALSE(fs::exists(whole + "/unfinished"));
  int kills = 0;
  for (const double after : {0.0, 0.03, 0.11, 0.4, 0.7}) {
    const auto result = run_program(run_of(name, killed, changes),
                                    {.interrupt_after_s = after, .signal = after == 0.4 ? SIGINT : SIGKILL});
    if (result.code == 0) break;
    ++kills;
  }
  REQUIRE(kills > 1);
  const auto last = run_program(run_of(name, killed, changes));
  CHECK(last.err == "");
  REQUIRE(last.code == 0);
  check_same(whole, killed);
  CHECK_FALSE(fs::exists(killed + "/unfinished"));
  CHECK(run_program({"verify", killed}).code == 0);
}

// Of one part and of many; with states that the deployed pose takes back, models that change within a run,
// loads that rods share, and an end that is not trusted and left out.
TEST_CASE("a second core changes no byte of a run") {
  const ScratchDirectory dir;
  const std::string scene = dir.write("everything.toml", everything);
  const auto [given, changes] = GENERATE(
      std::pair<std::string, Words>{"", {}}, std::pair<std::string, Words>{"", {"solver.end_time=0.9"}},
      std::pair<std::string, Words>{"hoop6", {"solver.step=0.013"}},
      std::pair<std::string, Words>{"hoop6", {"solver.step=0.007", "solver.at_deployed=latch"}},
      std::pair<std::string, Words>{"hoop6", {"solver.step=0.011", "structure.youngs_modulus=7e10"}},
      std::pair<std::string, Words>{"double_pendulum", {"solver.method=rk4", "solver.step=0.05"}},
      std::pair<std::string, Words>{"ladder", {"solver.method=rk4", "solver.step=0.001"}},
      std::pair<std::string, Words>{"cable_ring", {"solver.adaptive=true"}},
      std::pair<std::string, Words>{"hoop6_motor", {"solver.end_time=2.3"}});
  const std::string name = given.empty() ? scene : given;
  CAPTURE(name, changes);
  const std::string one = dir / "one", two = dir / "two";
  const auto run = [&, &given_changes = changes](const std::string& folder, const std::string& threads) {
    Words words = run_of(name, folder, given_changes);
    words.insert(words.end(), {"--threads", threads});
    return run_program(words);
  };
  const ProgramResult alone = run(one, "1"), both = run(two, "2");
  CHECK(alone.code == both.code);
  CHECK(alone.err == both.err);
  check_same(one, two);
  CHECK(run_program({"verify", two}).code == 0);
}

// Its tables take their places one after the other, then the checkpoint goes.
TEST_CASE("a run that is killed while its tables take their places goes on to the same bytes") {
  const ScratchDirectory dir;
  const std::string scene = dir.write("everything.toml", everything), whole = dir / "whole";
  REQUIRE(run_program(run_of(scene, whole, {})).code == 0);
  // Killed behind its first checkpoint; a run that was done before is made again.
  const auto killed_into = [&](const std::string& folder) {
    const std::string checkpoint = folder + "/unfinished/checkpoint";
    for (int i = 0; i < 50 && !fs::exists(checkpoint); ++i)
      run_program(run_of(scene, folder, {}),
                  {.interrupt_after_s = 0, .signal = SIGKILL, .first_wait_for = checkpoint});
    REQUIRE(fs::exists(checkpoint));
  };
  const std::vector<std::string> tables{"series.csv", "trajectory.csv", "rod_forces.csv"};
  for (std::size_t moved = 1; moved <= tables.size(); ++moved) {
    const std::string killed = dir / ("killed" + std::to_string(moved));
    killed_into(killed);
    for (std::size_t k = 0; k < moved; ++k)
      fs::rename(killed + "/unfinished/" + tables[k], killed + "/" + tables[k]);
    std::ofstream(killed + "/unfinished/.unfurl-0123456789abcdef.part") << "of a next checkpoint";
    REQUIRE(run_program(run_of(scene, killed, {})).code == 0);
    check_same(whole, killed);
    CHECK_FALSE(fs::exists(killed + "/unfinished"));
    CHECK(run_program({"verify", killed}).code == 0);
  }
  // And with a table that is lost it does not go on.
  const std::string lost = dir / "lost";
  killed_into(lost);
  fs::remove(lost + "/unfinished/series.csv");
  CHECK(run_program(run_of(scene, lost, {})).code == 5);
}

TEST_CASE("what a person has in a folder called unfinished, or behind a link of that name, is left alone") {
  const ScratchDirectory dir;
  const std::string out = dir / "out", linked = dir / "linked", other = dir / "other";
  const Words long_one{"solver.step=0.0005"};
  for (const std::string& folder : {out + "/unfinished", other}) {
    fs::create_directories(folder);
    std::ofstream(folder + "/series.csv") << "mine";
  }
  fs::create_directory(linked);
  fs::create_directory_symlink(other, linked + "/unfinished");
  for (const std::string& into : {out, linked}) {
    Words words = run_of("hoop6", into, long_one);
    words.emplace_back("--force");
    const auto result = run_program(words);
    CHECK(result.code == 0);
    CHECK(result.err.find("unfinished.kept-1") != std::string::npos);
    CHECK_FALSE(fs::exists(into + "/unfinished"));
    CHECK(file_text(into + "/unfinished.kept-1/series.csv") == "mine");
  }
  CHECK(std::distance(fs::directory_iterator(other), fs::directory_iterator()) == 1);
}

TEST_CASE("a checkpoint of another run is refused with one sentence and left alone") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  const Words long_one{"solver.step=1e-5"};
  run_program(
      run_of("hoop6", out, long_one),
      {.interrupt_after_s = 0.1, .signal = SIGKILL, .first_wait_for = out + "/unfinished/checkpoint"});
  REQUIRE(fs::exists(out + "/unfinished/checkpoint"));
  for (const Words& changes : {Words{"solver.step=2e-5"}, Words{"solver.step=1e-5", "structure.units=7"}}) {
    const auto other = run_program(run_of("hoop6", out, changes));
    CHECK(other.code == 5);
    CHECK(other.err.find("another scene") != std::string::npos);
    CHECK(fs::exists(out + "/unfinished/checkpoint"));
  }
  Words exported = run_of("hoop6", out, long_one);
  exported.insert(exported.end(), {"--export", "npy"});
  CHECK(run_program(exported).code == 5);
  // A film, of this scene or another, whole or of a mode, would take its place.
  for (const Words& film : {Words{"render", "hoop6", "--set", "solver.step=1e-5"},
                            Words{"render", "four_bar"}, Words{"render", "four_bar", "--mode", "1"}}) {
    Words words = film;
    words.insert(words.end(), {"-o", out, "--size", "64x48", "--fps", "2", "--quiet"});
    const auto refused = run_program(words);
    CHECK(refused.code == 5);
    CHECK(refused.err.find("holds an unfinished run, which a film cannot go on with") != std::string::npos);
    CHECK(fs::exists(out + "/unfinished/checkpoint"));
    CHECK_FALSE(fs::exists(out + "/film.json"));
  }
  // Cut short, or a byte of it changed.
  const std::string path = out + "/unfinished/checkpoint", text = file_text(path);
  fs::resize_file(path, text.size() - 9);
  CHECK(run_program(run_of("hoop6", out, long_one)).code == 5);
  CHECK(run_program({"run", "hoop6", "-o", out, "--force", "--quiet"}).code == 0);
  CHECK_FALSE(fs::exists(out + "/unfinished"));
  CHECK(run_program({"run", "hoop6", "-o", out, "--resume", "--quiet"}).code == 5);
}

// Where a file cannot grow any more a run ends with exit code 5, and all of what an earlier run wrote is
// there.
TEST_CASE("a run that finds the disk full leaves the results of an earlier one whole") {
  const ScratchDirectory dir;
  const std::string scene = dir.write("everything.toml", everything), out = dir / "out";
  const std::vector<std::string> files{"series.csv", "trajectory.csv", "rod_forces.csv", "scene.toml",
                                       "summary.json"};
  REQUIRE(run_program(run_of(scene, out, {"solver.end_time=0.1"})).code == 0);
  std::vector<std::string> before;
  for (const std::string& name : files) before.push_back(file_text(out + "/" + name));
  // Of one part, whose trajectory needs more than 100 kB; and in parts, whose tables need 10 MB.
  for (const auto& [end, bytes] : {std::pair{"1", 100000L}, std::pair{"30", 2000000L}}) {
    INFO(end);
    const auto full =
        run_program(run_of(scene, out, {std::string("solver.end_time=") + end}), {.largest_file = bytes});
    CHECK(full.code == 5);
    CHECK(full.err.find("file too large") != std::string::npos);
    for (std::size_t k = 0; k < files.size(); ++k) {
      INFO(files[k]);
      CHECK((file_text(out + "/" + files[k]) == before[k]));
    }
    for (const auto& entry : fs::directory_iterator(out))
      CHECK_FALSE(entry.path().filename().string().ends_with(".part"));
  }
  // With room again it goes on, and nothing of the earlier run stays.
  REQUIRE(run_program(run_of(scene, out, {})).code == 0);
  REQUIRE(run_program(run_of(scene, dir / "whole", {})).code == 0);
  check_same(dir / "whole", out);
  CHECK_FALSE(fs::exists(out + "/unfinished"));
  CHECK(run_program({"verify", out}).code == 0);
}

// The largest memory of the children so far [kB]: each run that is larger shows.
TEST_CASE("ten times as many steps take the same memory") {
  const ScratchDirectory dir;
  int runs = 0;
  const auto peak = [&](double end_time) {
    const std::string out = dir / ("o" + std::to_string(runs++));
    const std::string end = "solver.end_time=" + std::to_string(end_time);
    const pid_t child = ::fork();
    if (child == 0) {
      // Built with AddressSanitizer, the program keeps what it frees for a while: here it must not.
      ::setenv("ASAN_OPTIONS", "quarantine_size_mb=0", 1);
      ::execl(UNFURL_PROGRAM, "unfurl", "run", "double_pendulum", "-o", out.c_str(), "--quiet", "--set",
              end.c_str(), "--set", "solver.step=0.001", nullptr);
      ::_exit(127);
    }
    int status = 0;
    rusage used{};
    REQUIRE(::wait4(child, &status, 0, &used) == child);
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == 0);
    return static_cast<double>(used.ru_maxrss);
  };
  // Of runs alike the largest holds some 10 % more than the least, as their two threads meet: the least of
  // three.
  const auto least = [&](double end_time) {
    return std::min({peak(end_time), peak(end_time), peak(end_time)});
  };
  const double one = least(12), ten = least(120);
  CHECK(ten <= 1.1 * one);
}

}  // namespace unfurl::unfinished_run_test
