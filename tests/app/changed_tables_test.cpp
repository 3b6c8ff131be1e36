// SPDX-License-Identifier: BSD-3-Clause
// Tables that somebody changed, or put back, since unfurl finished them: verify tells, and no verb takes
// them.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/run_program.hpp"

namespace unfurl::changed_tables_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Words quick{"--set", "solver.end_time=0.1", "--set", "solver.step=0.05", "--dpi", "40", "--quiet"};

// Every verb that goes on with the rows of its table, and that table.
struct Measuring {
  std::string table;
  Words words;
};

const std::vector<Measuring>& measuring() {
  static const std::vector<Measuring> all{
      {"sweep.csv",
       Words{"sweep", "pendulum", "--vary", "structure.angle=10,20", "--measure", "energy"} + quick},
      {"sweep_1_of_2.csv", Words{"sweep", "pendulum", "--vary", "structure.angle=10,20,30", "--measure",
                                 "energy", "--shard", "1/2"} +
                               quick},
      {"study.csv",
       Words{"study", "pendulum", "--steps", "0.025:0.01", "--methods", "rk4", "--repeats", "1"} + quick},
      {"models.csv",
       Words{"study", "pendulum", "--models", "--repeats", "1", "--set", "solver.end_time=0.1", "--quiet"}}};
  return all;
}

// The last digit of the table is another one: nothing but a checksum tells.
std::string edited(const std::string& text) {
  std::string other = text;
  char& digit = other[other.find_last_of("0123456789")];
  digit = digit == '7' ? '8' : '7';
  return other;
}

}  // namespace

TEST_CASE("a finished table that was changed is told of by verify and taken by no verb") {
  const ScratchDirectory dir;
  for (const Measuring& m : measuring()) {
    INFO(m.table);
    const std::string out = dir / m.table, table = out + "/" + m.table;
    const Words words = m.words + Words{"-o", out};
    REQUIRE(run_program(words).code == 0);
    CHECK(run_program({"verify", out}).out.find("growing") == std::string::npos);
    const std::string right = file_text(table);
    for (const std::string& wrong : {edited(right), std::string(), std::string("mine"), right + "# remark\n",
                                     right.substr(0, right.size() - 1)}) {
      INFO(wrong);
      dir.write(m.table + "/" + m.table, wrong);
      const ProgramResult told = run_program({"verify", out});
      CHECK(told.code == 7);
      CHECK(told.out == "changed: " + m.table + "\n");
      const ProgramResult refused = run_program(words);
      CHECK(refused.code == 5);
      CHECK(refused.err == "unfurl: " + table +
                               ": was changed since unfurl wrote it, and its results are not taken; put back "
                               "what was written, or use --force to begin anew, which keeps it as " +
                               m.table + ".kept-1\n");
      CHECK(file_text(table) == wrong);
    }
    // What was written is taken again; what is somebody's is kept.
    dir.write(m.table + "/" + m.table, right);
    CHECK(run_program(words).code == 0);
    CHECK(file_text(table) == right);
    dir.write(m.table + "/" + m.table, "mine");
    const ProgramResult anew = run_program(words + Words{"--force"});
    CHECK(anew.code == 0);
    CHECK(anew.err.find(table + ".kept-1") != std::string::npos);
    CHECK(file_text(table + ".kept-1") == "mine");
    CHECK(run_program({"verify", out}).code == 0);
  }
}

// Nothing of them is read: they are in the way of new ones.
TEST_CASE("tables that no verb goes on with are kept aside where they were changed") {
  const ScratchDirectory dir;
  for (const std::string verb : {"modes", "margin"}) {
    INFO(verb);
    const std::string out = dir / verb, table = out + "/" + verb + ".csv";
    const Words words{verb, "hoop6", "--quiet", "-o", out};
    REQUIRE(run_program(words).code == 0);
    const std::string right = file_text(table), mine = edited(right);
    dir.write(verb + "/" + verb + ".csv", mine);
    const ProgramResult again = run_program(words);
    CHECK(again.code == 0);
    CHECK(again.err.find("it is kept as " + table + ".kept-1") != std::string::npos);
    CHECK(file_text(table) == right);
    CHECK(file_text(table + ".kept-1") == mine);
  }
}

// With --force a share begins anew beside another one at work, but puts nothing aside there.
TEST_CASE("a changed table of one share is not cured by the --force that was given") {
  const ScratchDirectory dir;
  const Words sweep{"sweep",     "pendulum",         "--vary",  "structure.angle=10:80:4000",
                    "--measure", "energy",           "--set",   "solver.end_time=1",
                    "--set",     "solver.step=2e-4", "--quiet", "-o",
                    dir / "s",   "--shard"};
  const std::string table = dir / "s/sweep_1_of_2.csv";
  std::string other =
      "timeout --foreground 60 \"" UNFURL_PROGRAM "\"";  // which else passes on a signal twice
  for (const std::string& word : sweep) other += " '" + word + "'";
  const std::string script =
      other + " 1/2 --threads 1 2>/dev/null & p=$!; " + other + " 2/2 --threads 1 2>/dev/null & q=$!; cd '" +
      (dir / "") + "'; until [ -s s/sweep_1_of_2.csv ]; do sleep 0.1; done; kill -INT $p; wait $p; " +
      "echo mine > s/sweep_1_of_2.csv; \"" UNFURL_PROGRAM "\"";
  std::string forced = script;
  for (const std::string& word : sweep) forced += " '" + word + "'";
  forced += " 1/2 --force 2>said; code=$?; kill $q; wait $q; exit $code";
  const int code = std::system(forced.c_str());
  CHECK(WEXITSTATUS(code) == 5);
  CHECK(file_text(dir / "said").find("put back what was written, or move it away: ") != std::string::npos);
  CHECK(file_text(table) == "mine\n");
}

TEST_CASE("changed tables are neither merged nor joined") {
  const ScratchDirectory dir;
  const Words sweep =
      Words{"sweep", "pendulum", "--vary", "structure.angle=10,20,30", "--measure", "energy"} + quick +
      Words{"-o"};
  for (const char* share : {"1/2", "2/2"})
    REQUIRE(run_program(sweep + Words{dir / "s", "--shard", share}).code == 0);
  const Words merge = sweep + Words{dir / "m", "--merge", dir / "s"};
  REQUIRE(run_program(merge).code == 0);
  const std::string share = dir / "s/sweep_2_of_2.csv", right = file_text(share);
  dir.write("s/sweep_2_of_2.csv", edited(right));
  const ProgramResult refused = run_program(merge);
  CHECK(refused.code == 5);
  CHECK(refused.err.find(share + ": was changed since unfurl wrote it") != std::string::npos);
  fs::remove(dir / "s/.unfurl");  // of files that were gathered nobody knows
  CHECK(run_program(sweep + Words{dir / "other", "--merge", dir / "s"}).code == 0);

  const Words join = sweep + Words{dir / "j", "--join", "--lease", "3"};
  REQUIRE(run_program(join).code == 0);
  CHECK(run_program({"verify", dir / "j"}).out.find("growing") == std::string::npos);
  std::string journal;
  for (const auto& entry : fs::directory_iterator(dir / "j/join"))
    if (entry.path().extension() == ".csv") journal = entry.path().filename().string();
  const std::string points = file_text(dir / "j/join/" + journal);
  dir.write("j/join/" + journal, edited(points));
  CHECK(run_program({"verify", dir / "j"}).code == 7);
  const ProgramResult joined = run_program(join);
  CHECK(joined.code == 5);
  CHECK(joined.err.find(journal + ": was changed since unfurl wrote it") != std::string::npos);
  fs::remove(dir / "j/join/" + journal);
  CHECK(run_program(join).code == 0);
}

// A kill leaves a table whose line in the list says that it grows, and a row that is torn.
TEST_CASE("a table that a kill left unfinished is gone on with") {
  const ScratchDirectory dir;
  for (const Measuring& m : measuring()) {
    INFO(m.table);
    const std::string out = dir / m.table, table = out + "/" + m.table;
    const Words words = m.words + Words{"-o", out};
    REQUIRE(run_program(words).code == 0);
    const std::string right = file_text(table), verb = m.words.front();
    dir.write(m.table + "/" + m.table, right.substr(0, right.size() - 2));
    std::ofstream(out + "/.unfurl", std::ios::app)
        << "---------------- " << m.table.substr(0, m.table.find_first_of("_.")) << " " << m.table << "\n";
    const ProgramResult open = run_program({"verify", out});
    CHECK(open.code == 0);
    CHECK(open.out.find("1 of them of growing content") != std::string::npos);
    const ProgramResult on = run_program(words);
    INFO(on.err);
    CHECK(on.code == 0);
    CHECK(on.err.find("kept-1") == std::string::npos);
    if (verb == "sweep") CHECK(file_text(table) == right);  // the others have CPU times
    const ProgramResult closed = run_program({"verify", out});
    CHECK(closed.code == 0);
    CHECK(closed.out.find("growing") == std::string::npos);
  }
}

// Killed at many moments, and ended by a signal: no state is taken for a person's.
TEST_CASE("a sweep that is killed or stopped at any moment goes on to the same table") {
  const ScratchDirectory dir;
  const Words sweep{"sweep",     "hoop6_sector",
                    "--vary",    "structure.fold_angle=30:85:20",
                    "--vary",    "structure.hinge_force=100:300:10",
                    "--measure", "deploy_time",
                    "--dpi",     "40",
                    "--threads", "1",
                    "--quiet",   "-o"};
  REQUIRE(run_program(sweep + Words{dir / "one"}).code == 0);
  const std::string right = file_text(dir / "one/sweep.csv"), out = dir / "many";
  std::string words;
  for (const std::string& word : sweep) words += "'" + word + "' ";
  for (const char* signal : {"KILL", "INT"})
    for (int moment = 1; moment <= 8; ++moment) {
      INFO(signal << " " << moment);
      const std::string command = "timeout -s " + std::string(signal) + " 0." + std::to_string(moment) +
                                  " \"" UNFURL_PROGRAM "\" " + words + "'" + out + "' 2>'" + dir / "said" +
                                  "'";
      CHECK(std::system(command.c_str()) >= 0);
      CHECK(file_text(dir / "said").find("was changed") == std::string::npos);
    }
  const std::string rest = "\"" UNFURL_PROGRAM "\" " + words + "'" + out + "'";  // of the same build
  CHECK(std::system(rest.c_str()) == 0);
  CHECK(file_text(out + "/sweep.csv") == right);
  CHECK_FALSE(fs::exists(out + "/sweep.csv.kept-1"));
  CHECK(run_program({"verify", out}).out.find("growing") == std::string::npos);
}

TEST_CASE("a table of an earlier run that was put back is none of the last one") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  const Words run{"run", "pendulum", "--set", "solver.end_time=0.1", "--quiet", "-o", out, "--set"};
  REQUIRE(run_program(run + Words{"solver.step=0.01"}).code == 0);
  const std::string earlier = file_text(out + "/series.csv");
  REQUIRE(run_program(run + Words{"solver.step=0.005"}).code == 0);
  CHECK(run_program({"verify", out}).code == 0);
  dir.write("out/series.csv", earlier);
  const ProgramResult told = run_program({"verify", out});
  CHECK(told.code == 7);
  CHECK(told.out == "earlier: series.csv is as an earlier command wrote it, not as the last one did\n");
  // It is still one of unfurl's: the next run replaces it and keeps none. Back and forth it is as written.
  for (const char* step : {"0.01", "0.005", "0.01"}) {
    const ProgramResult again = run_program(run + Words{std::string("solver.step=") + step});
    CHECK(again.code == 0);
    CHECK(again.err.empty());
    CHECK(run_program({"verify", out}).code == 0);
  }
  CHECK(file_text(out + "/series.csv") == earlier);
  // Builds that did not say so had a line once, wherever it stood: their last one says nothing.
  const std::string list = file_text(out + "/.unfurl");
  const std::size_t title = list.find('\n'), mark = list.find(", in order");
  REQUIRE(mark < title);
  std::string lines;
  std::istringstream in_order(list.substr(title + 1));
  for (std::string line; std::getline(in_order, line);) lines.insert(0, line + "\n");
  dir.write("out/.unfurl", list.substr(0, title + 1) + lines);
  CHECK(run_program({"verify", out}).code == 7);
  dir.write("out/.unfurl", list.substr(0, mark) + "\n" + lines);
  CHECK(run_program({"verify", out}).code == 0);
}

}  // namespace unfurl::changed_tables_test
