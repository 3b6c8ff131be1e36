// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace unanswered_sweep_test {

TEST_CASE("a sweep says why a point has no answer and ends as a run would where none has") {
  const ScratchDirectory dir;
  const std::string scene = dir.write("rod.toml", R"([structure]
kind = "custom"
[[structure.nodes]]
name = "A"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "B"
position = [0.6, 0, 0.8]
mass = 1.3
[[structure.rods]]
nodes = ["A", "B"]
mass = 0
[solver]
end_time = 0.01
)");
  const auto sweep = [&](const std::string& values, const std::string& to, const std::string& shard) {
    return run_program({"sweep", scene, "--vary", "structure.nodes.B.fixed=" + values, "--measure",
                        "end_time", "-o", dir / to, "--shard", shard});
  };
  // A rod between two fixed nodes can do nothing; one of two answers is a result, none is not, unless other
  // shards may have some.
  const std::string why = "unfurl: warning: invalid: structure.nodes.B.fixed=true: ";
  const ProgramResult some = sweep("false,true", "some", "1/1"), none = sweep("true", "none", "1/1");
  INFO(some.err << none.err);
  CHECK(some.code == 0);
  CHECK(some.err.starts_with(why));
  CHECK(some.err.find("nothing can move") != std::string::npos);
  CHECK(none.code == 3);
  CHECK(none.err.starts_with(why));
  CHECK(sweep("true", "share", "1/2").code == 0);
  // An earlier run knew; the same command again names one that tells.
  const ProgramResult again = sweep("true", "none", "1/1");
  CHECK(again.code == 3);
  CHECK(again.err.starts_with(
      "unfurl: warning: invalid: unfurl run " + scene +
      " --json --set structure.nodes.B.fixed=true --set solver.model=auto tells why\n"));
}

// A uniform rod of 2 kg and 4 m that falls from the horizontal has lost m g L / 2 at most: 39.24 J, of 1 m
// 9.81 J, to the quarter per mille that a table's digits and the step's way past the lowest point leave.
TEST_CASE("points that name a file belong to its contents, by the key as by a variable") {
  const ScratchDirectory dir;
  const auto nodes = [](const std::string& length) {
    return "name,x,y,z,fixed\nA,0,0,0,true\nB," + length + ",0,0,false\n";
  };
  dir.write("r.csv", "a,b,mass\nA,B,2\n");
  const std::string rest =
      "rods_file = 'r.csv'\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstep = 0.002\nend_time = 2\n";
  const std::string by_key =
      dir.write("key.toml", "[structure]\nkind = 'custom'\nnodes_file = 'n1.csv'\n" + rest);
  const std::string by_variable = dir.write(
      "variable.toml", "[variables]\nk = 1\n[structure]\nkind = 'custom'\nnodes_file = 'n{k}.csv'\n" + rest);
  struct Asked {
    std::string scene, key, values;
  };
  for (const Asked& asked :
       {Asked{by_key, "structure.nodes_file", "n1.csv,n2.csv"}, Asked{by_variable, "variables.k", "1,2"}}) {
    INFO(asked.scene);
    const std::string out = dir / asked.key;
    dir.write("n1.csv", nodes("2"));
    dir.write("n2.csv", nodes("4"));
    const std::vector<std::string> sweep{"sweep",     asked.scene,
                                         "--vary",    asked.key + "=" + asked.values,
                                         "--measure", "max:kinetic_energy_J",
                                         "--dpi",     "40",
                                         "--quiet",   "-o",
                                         out};
    const auto last = [&] {
      const std::string table = file_text(out + "/sweep.csv");
      return std::stod(table.substr(table.rfind(',') + 1));
    };
    const ProgramResult first = run_program(sweep);
    INFO(first.err);
    REQUIRE(first.code == 0);
    CHECK(last() == Approx(2 * 9.81 * 2).epsilon(2.5e-4));
    CHECK(run_program(sweep).code == 0);
    dir.write("n2.csv", nodes("1"));
    const ProgramResult other = run_program(sweep);
    CHECK(other.code == 5);
    CHECK(other.err.find("holds results of another scene or other settings") != std::string::npos);
    std::vector<std::string> anew = sweep;
    anew.emplace_back("--force");
    CHECK(run_program(anew).code == 0);
    CHECK(last() == Approx(2 * 9.81 * 0.5).epsilon(2.5e-4));
    // One that is gone is another one, too; one that comes later has had no answer.
    std::filesystem::remove(dir / "n2.csv");
    CHECK(run_program(sweep).code == 5);
    CHECK(run_program(anew).code == 0);
    CHECK(file_text(out + "/sweep.csv").find("invalid") != std::string::npos);
    CHECK(run_program(sweep).code == 0);
    dir.write("n2.csv", nodes("1"));
    CHECK(run_program(sweep).code == 0);
    CHECK(last() == Approx(2 * 9.81 * 0.5).epsilon(2.5e-4));
    dir.write("n2.csv", nodes("2"));
    CHECK(run_program(sweep).code == 5);
  }
}

// More values name more files: what is there stays, whichever files were looked at.
TEST_CASE("a sweep over the names of files goes on with more of them") {
  const ScratchDirectory dir;
  const auto nodes = [&](const std::string& file, const std::string& length) {
    dir.write(file, "name,x,y,z,fixed\nA,0,0,0,true\nB," + length + ",0,0,false\n");
  };
  dir.write("r.csv", "a,b,mass\nA,B,2\n");
  for (const char* i : {"1", "2"})
    for (const char* k : {"1", "2", "3"}) nodes(std::string("n") + i + "_" + k + ".csv", k);
  const std::string rest =
      "'\nrods_file = 'r.csv'\n[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstep = 0.01\nend_time = "
      "0.1\n";
  const std::string kind = "[structure]\nkind = 'custom'\nnodes_file = '";
  const std::string by_key = dir.write("key.toml", kind + "n1_1.csv" + rest);
  const std::string by_two =
      dir.write("two.toml", "[variables]\ni = 1\nk = 1\n" + kind + "n{i}_{k}.csv" + rest);
  struct Asked {
    std::string scene;
    std::vector<std::string> few, more, fewer;
  };
  for (const Asked& asked : {Asked{by_key,
                                   {"--vary", "structure.nodes_file=n1_1.csv,n1_2.csv"},
                                   {"--vary", "structure.nodes_file=n1_1.csv,n1_3.csv,n1_2.csv"},
                                   {"--vary", "structure.nodes_file=n1_1.csv,n1_3.csv"}},
                             Asked{by_two,
                                   {"--vary", "variables.i=1,2", "--vary", "variables.k=1,2"},
                                   {"--vary", "variables.i=1,2", "--vary", "variables.k=1:3:3"},
                                   {"--vary", "variables.i=1,2", "--vary", "variables.k=1,3"}}}) {
    INFO(asked.scene);
    nodes("n1_3.csv", "3");
    const auto sweep = [&](const std::vector<std::string>& values, const std::string& out) {
      std::vector<std::string> words{"sweep",  asked.scene, "--measure", "max:kinetic_energy_J",
                                     "--dpi",  "40",        "--quiet",   "-o",
                                     dir / out};
      words.insert(words.end(), values.begin(), values.end());
      return run_program(words);
    };
    const std::string out = "out" + std::to_string(asked.few.size());
    REQUIRE(sweep(asked.few, out).code == 0);
    const ProgramResult more = sweep(asked.more, out);
    INFO(more.err);
    CHECK(more.code == 0);
    REQUIRE(sweep(asked.more, out + "whole").code == 0);
    CHECK(file_text(dir / (out + "/sweep.csv")) == file_text(dir / (out + "whole/sweep.csv")));
    const ProgramResult fewer = sweep(asked.fewer, out);
    CHECK(fewer.code == 5);
    CHECK(fewer.err.find("ask for them, too") != std::string::npos);
    CHECK(sweep(asked.more, out).code == 0);
    nodes("n1_3.csv", "4");
    CHECK(sweep(asked.more, out).code == 5);
  }
}

TEST_CASE("what is wrong with an axis is said of --vary") {
  const ScratchDirectory dir;
  const auto sweep = [&](const std::string& axis) {
    return run_program({"sweep", "pendulum", "--set", "solver.end_time=0.01", "--vary", axis, "--measure",
                        "end_time", "-o", dir / "out"});
  };
  const ProgramResult key = sweep("structure.lenth=1,2");
  CHECK(key.code == 3);
  CHECK(key.err.find("--vary structure.lenth: unknown key; did you mean 'length'?") != std::string::npos);
  const ProgramResult value = sweep("solver.step=0,0.01");
  INFO(value.err);
  CHECK(value.code == 0);
  CHECK(value.err.find("invalid: solver.step=0: --vary solver.step: must be > 0 s; got 0") !=
        std::string::npos);
}

// Steps of 0.06 s of a double pendulum that whirls: runs warn of their balance, and so do what runs them.
TEST_CASE("what runs are warned of is told where many are made") {
  const ScratchDirectory dir;
  const std::vector<std::string> coarse{"--set", "solver.end_time=1", "--set", "solver.stages=2",
                                        "--set", "solver.step=0.06"};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), coarse.begin(), coarse.end());
    return run_program(words);
  };
  const std::string said = "the energy balance is off by ";
  const ProgramResult run =
      with({"run", "double_pendulum", "-o", dir / "run", "--quiet", "--set", "structure.rods[0].mass=2"});
  REQUIRE(run.err.find("unfurl: warning: " + said) != std::string::npos);
  const std::string told = run.err.substr(run.err.find(said), run.err.find('\n') - run.err.find(said));
  const ProgramResult sweep = with({"sweep", "double_pendulum", "-o", dir / "sweep", "--vary",
                                    "structure.rods[0].mass=2,2.05", "--measure", "peak_speed"});
  INFO(sweep.err);
  CHECK(sweep.code == 0);
  CHECK(sweep.err.find("unfurl: warning: structure.rods[0].mass=2: " + told + "\n") != std::string::npos);
  CHECK(sweep.err.find("unfurl: warning: 2 of 2 points are warned of") != std::string::npos);
  const ProgramResult solve = with({"solve", "double_pendulum", "--find", "structure.rods[0].mass",
                                    "--target", "final:kinetic_energy_J=6.4", "--between", "1.9:2.1"});
  CHECK(solve.code == 0);
  CHECK(solve.err.starts_with("unfurl: warning: " + said));
}

// The scene's own fold angle is 70 degrees, at which seven units do not fit.
TEST_CASE("a study whose points are right needs no scene that is right without them") {
  const ScratchDirectory dir;
  const auto with = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--set", "structure.units=7"});
    return run_program(words);
  };
  const ProgramResult sweep = with({"sweep", "hoberman", "-o", dir / "sweep", "--vary",
                                    "structure.fold_angle=20,40", "--measure", "deploy_time"});
  INFO(sweep.err);
  CHECK(sweep.code == 0);
  CHECK(sweep.err.find("warning") == std::string::npos);
  const ProgramResult solve = with({"solve", "hoberman", "--find", "structure.fold_angle", "--target",
                                    "deploy_time=0.4", "--between", "20:60"});
  INFO(solve.err);
  CHECK(solve.code == 0);
}

TEST_CASE("a failed run is no modelling choice to compare with") {
  const ScratchDirectory dir;
  const ProgramResult study =
      run_program({"study", "double_pendulum", "--models", "-o", dir / "models", "--repeats", "1", "--set",
                   "solver.method=rk4", "--set", "solver.step=0.05"});
  INFO(study.err);
  CHECK(study.code == 4);
  CHECK(study.err.find("unfurl: warning: as the scene says: failed: ") != std::string::npos);
  const std::string report = file_text(dir / "models/models.md");
  const std::size_t row = report.find("| as the scene says (failed: from t = ");
  REQUIRE(row != std::string::npos);
  // Neither differences nor forces nor their times.
  CHECK(report.substr(row, report.find('\n', row) - row).ends_with("|  |  |  |  |  |"));
}

// With a hinge force F the ring deploys at 4.92 s sqrt(200 N / F), so after the scene's 6 s below 134 N.
TEST_CASE("solve tells where the run of its answer ended before the structure was deployed") {
  const auto solve = [](const std::string& end, const std::string& option) {
    return run_program({"solve", "hoop6_sector", "--find", "structure.hinge_force", "--target",
                        "peak_rod_force=1000", "--set", "solver.end_time=" + end, option});
  };
  const ProgramResult early = solve("6", "--json");
  CHECK(early.err.find(
            "unfurl: warning: its motion ends early: 99.4 % deployed when end_time = 6 s was reached") == 0);
  CHECK(early.out.find("\"notes\": [\n    \"99.4 % deployed") != std::string::npos);
  const ProgramResult whole = solve("20", "--json");
  CHECK(whole.err.find("ends early") == std::string::npos);
  CHECK(whole.out.find("\"notes\": []") != std::string::npos);
}

TEST_CASE("margin --stuck of a ring too fine for its whole path names that of a sector") {
  const std::vector<std::string> words{
      "margin", "hoop6", "--stuck", "--set", "structure.fold_angle=80", "--set", "structure.units=28"};
  const ProgramResult whole = run_program(words);
  CHECK(whole.code == 3);
  CHECK(whole.err.find("may go further: --set structure.model=sector\n") != std::string::npos);
  std::vector<std::string> by_sector = words;
  by_sector.insert(by_sector.end(), {"--set", "structure.model=sector"});
  CHECK(run_program(by_sector).code == 0);
}

}  // namespace unanswered_sweep_test
