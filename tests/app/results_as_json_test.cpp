// SPDX-License-Identifier: BSD-3-Clause
// What a script reads of studies and of verify: the numbers of the tables that they write.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/run_program.hpp"

using namespace unfurl;
using Json = nlohmann::ordered_json;

namespace results_as_json_test {

namespace {

// The lines of a table without quotes, cell by cell.
std::vector<std::vector<std::string>> cells(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line, cell; std::getline(lines, line);) {
    rows.emplace_back();
    for (std::istringstream rest(line + ","); std::getline(rest, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

void check_same(const Json& rows, const std::string& table) {
  const auto read = cells(table);
  REQUIRE(read.size() > 1);
  REQUIRE(rows.size() == read.size() - 1);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    REQUIRE(rows[r].size() == read[0].size());
    std::size_t c = 0;
    for (const auto& [column, cell] : rows[r].items()) {
      CHECK(column == read[0][c]);
      const std::string& text = read[r + 1][c++];
      if (cell.is_string())
        CHECK(cell == text);
      else if (cell.is_null())
        CHECK(text == "");
      else
        CHECK(cell.get<double>() == std::stod(text));  // both have all digits
    }
  }
}

}  // namespace

TEST_CASE("studies with --json print the numbers of their tables and nothing else") {
  const ScratchDirectory dir;
  const ProgramResult sweep = run_program({"sweep", "four_bar", "--vary", "solver.step=0.01,0.02",
                                           "--measure", "peak_speed,peak_rod_force", "-o", dir / "sweep",
                                           "--json", "--set", "solver.end_time=0.1"});
  INFO(sweep.err);
  REQUIRE(sweep.code == 0);
  CHECK(Json::parse(sweep.out)["complete"] == true);
  check_same(Json::parse(sweep.out)["rows"], file_text(dir / "sweep/sweep.csv"));
  const ProgramResult study =
      run_program({"study", "four_bar", "--methods", "dvm", "--steps", "0.02:0.01", "--repeats", "1", "-o",
                   dir / "study", "--json", "--quiet", "--set", "solver.end_time=0.2"});
  INFO(study.err);
  REQUIRE(study.code == 0);
  check_same(Json::parse(study.out)["rows"], file_text(dir / "study/study.csv"));
}

TEST_CASE("verify as JSON names what is not as it was written") {
  const ScratchDirectory dir;
  REQUIRE(
      run_program({"run", "four_bar", "-o", dir / "out", "--quiet", "--set", "solver.end_time=0.1"}).code ==
      0);
  const ProgramResult same = run_program({"verify", dir / "out", "--json"});
  CHECK(same.code == 0);
  CHECK(Json::parse(same.out)["as_written"] == true);
  CHECK(Json::parse(same.out)["changed"].empty());
  std::ofstream(dir / "out/series.csv", std::ios::app) << "1\n";
  std::filesystem::remove(dir / "out/trajectory.csv");
  const ProgramResult other = run_program({"verify", dir / "out", "--json"});
  CHECK(other.code == 7);
  const Json told = Json::parse(other.out);
  CHECK(told["as_written"] == false);
  CHECK(told["changed"] == Json{"series.csv"});
  CHECK(told["missing"] == Json{"trajectory.csv"});
  // A figure far from its results says the same by the receipt in it.
  REQUIRE(run_program({"figure", "four_bar", "energy", "-o", dir / "e.svg", "--force", "--quiet"}).code == 0);
  std::filesystem::remove(dir / ".unfurl");
  CHECK(Json::parse(run_program({"verify", dir / "e.svg", "--json"}).out)["as_written"] == true);
}

TEST_CASE("every verb tells the version and those that name a file take --force") {
  for (const char* verb : {"run", "study", "check", "list", "verify"})
    CHECK(run_program({verb, "--version"}).out == "unfurl 0.1.0\n");
  // --json where there is another thing to print or nothing to tell.
  CHECK(run_program({"sweep", "four_bar", "--vary", "solver.step=0.01,0.02", "--measure", "peak_speed", "-o",
                     "x", "--script", "slurm", "--json"})
            .err == "unfurl: --script prints a job, not a result; leave out --json\n");
}

}  // namespace results_as_json_test
