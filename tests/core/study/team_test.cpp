// SPDX-License-Identifier: BSD-3-Clause
// Leases: who holds a piece of work, and who takes it over.
#include "core/study/team.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "core/scene/library.hpp"
#include "core/study/journal.hpp"
#include "core/study/stress.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace team_test {

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("unfurl_team_" + std::to_string(::getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a piece of work is one worker's until that gives it back") {
  const Folder scratch;
  const fs::path folder = scratch.path / "join";
  Team one(folder, 60);
  CHECK(one.takes("points-3"));
  CHECK(one.takes("points-3"));
  CHECK(one.holds("points-3"));
  CHECK_FALSE(one.holds("points-4"));
  {
    Team two(folder, 60);
    CHECK(one.journal() != two.journal());
    CHECK_FALSE(two.takes("points-3"));
    CHECK(two.takes("points-4"));
    CHECK_FALSE(one.takes("points-4"));
  }
  CHECK(one.takes("points-4"));  // at once: its worker went
  {
    Team three(folder, 60);
    CHECK(three.takes("points-5"));
    three.done();
  }
  CHECK_FALSE(one.takes("points-5"));  // done, and nobody is to begin it again
}

TEST_CASE("those who wait for a piece are told when it is finished, not when its worker goes") {
  const Folder scratch;
  const fs::path folder = scratch.path / "join";
  Team waiting(folder, 60);
  CHECK_FALSE(waiting.finished("results"));
  {
    Team interrupted(folder, 60);
    REQUIRE(interrupted.takes("results"));
    CHECK_FALSE(waiting.finished("results"));
  }
  CHECK_FALSE(waiting.finished("results"));
  {
    Team writer(folder, 60);
    REQUIRE(writer.takes("results"));  // at once: given back
    CHECK_FALSE(waiting.takes("results"));
    writer.finish("results");
    CHECK(waiting.finished("results"));
    waiting.finish("results");  // not its own: nothing
  }
  CHECK(waiting.finished("results"));
  CHECK(waiting.takes("results"));  // who is given the same command later may write them again
  CHECK_FALSE(waiting.finished("results"));
}

TEST_CASE("names that differ in any character are different pieces") {
  const Folder scratch;
  const fs::path folder = scratch.path / "join";
  Team one(folder, 60);
  Team two(folder, 60);
  for (const char* name : {"dvm 4", "dvm_4", "dvm/4", "../dvm 4", "dvm.4", "force-1e+09"}) {
    INFO(name);
    CHECK(one.takes(name));
    CHECK_FALSE(two.takes(name));
  }
  for (const auto& entry : fs::directory_iterator(folder.parent_path()))
    CHECK(entry.path().extension() != ".lease");  // nothing leaves the folder
}

TEST_CASE("the lease of a worker that lives is renewed, a dead one's is taken over and lost to it") {
  const Folder scratch;
  const fs::path folder = scratch.path / "join";
  Team alive(folder, 0.5), other(folder, 0.5);
  REQUIRE(alive.takes("a"));
  // Of a worker that was killed: a lease that nobody renews, ten seconds old.
  std::ofstream(folder / "b.0.lease") << "somebody\n";
  fs::last_write_time(folder / "b.0.lease", fs::file_time_type::clock::now() - std::chrono::seconds(10));
  // Two leases' time: eight renewals and more.
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (std::chrono::steady_clock::now() < until) REQUIRE_FALSE(other.takes("a"));
  int taken_over = 0;
  const auto count = [&] { ++taken_over; };
  CHECK(other.takes("b", count));
  CHECK(taken_over == 1);  // it may be finished
  CHECK(other.takes("b", count));
  CHECK(other.takes("c", count));
  CHECK(taken_over == 1);
  CHECK_FALSE(alive.takes("b"));
  // Whoever was stopped past its lease finds a later one beside its own.
  std::ofstream(folder / "a.1.lease") << "somebody\n";
  CHECK_FALSE(alive.holds("a"));
  CHECK_FALSE(alive.takes("a"));
}

TEST_CASE("a journal takes in what others have finished, and leaves their files alone") {
  const Folder scratch;
  const fs::path folder = scratch.path / "join";
  fs::create_directories(folder);
  const std::vector<std::string> columns{"key", "value"};
  Journal own(folder / "own.csv", columns, 1, {1});
  own.append({"a", "1"});
  const std::string torn = "key,value\na,2\nb,3\nc,";
  std::ofstream(folder / "other.csv") << torn;
  own.take_in(folder / "other.csv");
  CHECK(own.find({"a"})->at(1) == "1");  // what both have stays
  CHECK(own.find({"b"})->at(1) == "3");
  CHECK(own.find({"c"}) == nullptr);
  CHECK(text_of(folder / "other.csv") == torn);
  CHECK(text_of(folder / "own.csv") == "key,value\na,1\n");
}

TEST_CASE("the sites of an atlas that another worker is at are left to it, and taken in when it is done") {
  const Folder scratch;
  StressPlan plan = plan_stress({find_scene("hoop6_sector"), {}}, {"force"});
  plan.extremes[0].values = {1, 1e6};
  plan.settings.resize(1);
  plan.steps = {16, 32};
  const auto journal_of = [](const Team& team) {
    return std::make_unique<Journal>(team.journal(), stress_columns(), stress_key_columns);
  };
  Team team(scratch.path / "join", 60);
  const auto own = journal_of(team);
  StudyHooks hooks;
  hooks.team = &team;
  {
    Team other(scratch.path / "join", 60);
    REQUIRE(other.takes("force-1e+06"));
    const Stress part = run_stress(plan, *own, hooks);
    CHECK_FALSE(part.complete);
    REQUIRE(part.cells.size() == 2);
    CHECK(part.cells[0].value == 1);
    const auto theirs = journal_of(other);
    StudyHooks of_other;
    of_other.team = &other;
    CHECK_FALSE(run_stress(plan, *theirs, of_other).complete);  // without ours
    own->take_in(other.journal());
  }
  const Stress all = run_stress(plan, *own, hooks);
  CHECK(all.complete);
  CHECK(all.cells.size() == 4);
  CHECK(own->find({"force", "1e+06", plan.settings[0].name, "32"}) != nullptr);
  Journal in_file({}, stress_columns(), stress_key_columns);
  in_file.take_in(team.journal());
  CHECK(in_file.size() == 2);  // theirs came from their file
}

// What rubs from the start has no reference at any size of its forces, and so no row: two workers that hold a
// site each waited for one another as long as they lived.
TEST_CASE("sites of an atlas that have no reference are done for all workers") {
  const Folder scratch;
  const auto text = std::make_shared<const std::string>(R"(
[structure]
kind = "pendulum"
angle = 90.0
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "friction"
nodes = ["bob"]
direction = [0, 0, 1]
kinetic = 0.1
)");
  StressPlan plan = plan_stress({"one.toml", {}, text, "."}, {"force"});
  plan.settings.resize(1);
  plan.steps = {16};
  Team one(scratch.path / "join", 60), two(scratch.path / "join", 60);
  const auto done = [&](Team& team, std::vector<double> values) {
    plan.extremes[0].values = std::move(values);
    Journal journal(team.journal(), stress_columns(), stress_key_columns);
    StudyHooks hooks;
    hooks.team = &team;
    const Stress found = run_stress(plan, journal, hooks);
    CHECK(found.cells.empty());
    return found.complete;
  };
  CHECK(done(one, {1}));
  CHECK(done(two, {10}));
  CHECK(done(one, {1, 10}));
  CHECK(done(two, {1, 10}));
}

}  // namespace team_test
