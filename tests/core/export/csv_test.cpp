// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/csv.hpp"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/export/atomic_file.hpp"
#include "core/export/checksum.hpp"
#include "core/export/run_tables.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;

namespace csv_test {

namespace {

struct TemporaryFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("unfurl_csv_" + std::to_string(::getpid()) + ".csv");
  ~TemporaryFile() { std::filesystem::remove(path); }
};

Simulation short_run(const std::string& scene, const std::vector<std::string>& overrides) {
  const Scene s = read_scene_file(find_scene(scene), overrides);
  return simulate(build_model(s), s.solver);
}

// Rows of cells; no cell of these tables holds a comma.
std::vector<std::vector<std::string>> table(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

double number(const std::string& cell) {
  double x = -1;
  std::from_chars(cell.data(), cell.data() + cell.size(), x);
  return x;
}

}  // namespace

// Who watches files is told what is in them, however their rows came together: in pieces, of which some were
// taken back, and where a finisher puts something behind them.
TEST_CASE("a table's checksum is that of its file") {
  struct Watcher final : FileWatcher, FileFinisher {
    std::string told, behind;
    void before_file(const std::filesystem::path&, const std::string& checksum) override { told = checksum; }
    std::string note(const std::filesystem::path&) override { return ""; }
    bool finish(const std::filesystem::path& temporary, const std::filesystem::path&) override {
      std::ofstream(temporary, std::ios::app | std::ios::binary) << behind;
      return !behind.empty();
    }
  } watcher;
  watcher.behind = GENERATE("", "# note\n");
  const Simulation run = short_run("double_pendulum", {"solver.end_time=0.3"});
  const Trajectory& t = run.trajectory;
  const Diagnostics d = diagnose(run);
  FileWatcher* const watcher_before = watch_files(&watcher);
  FileFinisher* const finisher_before = finish_files(&watcher);
  const TemporaryFile whole, file;
  write_trajectory_csv(whole.path, t);
  CHECK(watcher.told == checksum_of_file(whole.path));
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, t.size()}) {
    RowsAhead ahead;
    for (std::size_t i = 0; i < t.size(); i += piece)
      ahead.add(t.part(i, std::min(i + piece, t.size()), t.options()));
    CHECK(ahead.states() == t.size());
    ahead.cut(t.size() - 1);
    CHECK(ahead.states() < t.size());
    PendingFile pending(file.path);
    write_trajectory_csv(pending, t, ahead);
    pending.commit();
    CHECK(watcher.told == checksum_of_file(file.path));
    CHECK(watcher.told == checksum_of_file(whole.path));
  }
  write_series_csv(file.path, d);
  CHECK(watcher.told == checksum_of_file(file.path));
  write_rod_forces_csv(file.path, t, d);
  CHECK(watcher.told == checksum_of_file(file.path));
  watch_files(watcher_before);
  finish_files(finisher_before);
}

TEST_CASE("the trajectory in CSV is the trajectory, bit for bit") {
  const Simulation run = short_run("double_pendulum", {"solver.end_time=0.2"});
  const TemporaryFile file;
  write_trajectory_csv(file.path, run.trajectory);
  const auto rows = table(file.path);
  REQUIRE(rows.size() == run.trajectory.size() + 1);
  CHECK(rows[0].size() == 1 + 6 * 3);
  CHECK(rows[0][0] == "t_s");
  CHECK(rows[0][7] == "elbow.x_m");
  CHECK(rows[0][12] == "elbow.vz_m_s");
  for (std::size_t i = 0; i < run.trajectory.size(); ++i) {
    CHECK(number(rows[i + 1][0]) == run.trajectory.time(i));
    CHECK(number(rows[i + 1][9]) == run.trajectory.positions(i)[5]);
    CHECK(number(rows[i + 1][18]) == run.trajectory.velocities(i)[8]);
  }
}

TEST_CASE("the series in CSV have one row per state and one column per diagnostic") {
  const Simulation run = short_run("hoop6_sector", {"solver.end_time=0.1"});
  const Diagnostics diagnostics = diagnose(run);
  const TemporaryFile file;
  write_series_csv(file.path, diagnostics);
  const auto rows = table(file.path);
  REQUIRE(rows.size() == diagnostics.t.size() + 1);
  REQUIRE(rows[0].size() == diagnostics.columns.size() + 1);
  for (std::size_t c = 0; c < diagnostics.columns.size(); ++c) {
    CHECK(rows[0][c + 1] == diagnostics.columns[c].name);
    CHECK(number(rows.back()[c + 1]) == diagnostics.columns[c].values.back());
  }
}

TEST_CASE("rod forces of a sector are written for every rod of the whole") {
  const Simulation run = short_run("hoop6_sector", {"solver.end_time=0.1"});
  const TemporaryFile file;
  write_rod_forces_csv(file.path, run.trajectory, diagnose(run));
  const auto rows = table(file.path);
  CHECK(rows[0].size() == 1 + 2 * 30);
  CHECK(rows[1].size() == 1 + 2 * 30);
  // All posts of a ring that keeps its symmetry carry the same force: they are copies of one.
  const std::size_t first_post = 5, second_post = 10;
  REQUIRE(rows[0][first_post] == "B0-T0.axial_force_N");
  REQUIRE(rows[0][second_post] == "B1-T1.axial_force_N");
  CHECK(rows[5][first_post] == rows[5][second_post]);
}

TEST_CASE("beside each rod force stands whether it is unique, behind all forces") {
  const Simulation run = short_run("hoop6", {"solver.end_time=0.05"});
  const TemporaryFile file;
  write_rod_forces_csv(file.path, run.trajectory, diagnose(run));
  const auto rows = table(file.path);
  const auto& rods = run.trajectory.structure().rod_copies;
  REQUIRE(rows[0].size() == 1 + 2 * rods.size());
  for (std::size_t r = 0; r < rods.size(); ++r) {
    CHECK(rows[0][1 + r] == rods[r].name + ".axial_force_N");
    CHECK(rows[0][1 + rods.size() + r] == rods[r].name + ".axial_force_unique");
    const bool post =
        run.trajectory.structure().rods[static_cast<std::size_t>(rods[r].source)].group == "post";
    for (std::size_t i = 1; i < rows.size(); ++i) CHECK(rows[i][1 + rods.size() + r] == (post ? "1" : "0"));
  }
}

TEST_CASE("tables that grow are in the end those that are written at once also after they were cut") {
  const Simulation run = short_run("hoop6_sector", {"solver.end_time=0.1", "solver.step=0.01"});
  const Diagnostics d = diagnose(run);
  const std::size_t states = run.trajectory.size();
  const auto folder = std::filesystem::temp_directory_path() / ("unfurl_grow_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  {
    RunTables tables(folder);
    tables.add(run.trajectory, d, 0, 3);
    const RunTables::Sizes three = tables.sizes();
    CHECK(three.series == std::filesystem::file_size(folder / "series.csv"));
    CHECK(three.rod_forces == std::filesystem::file_size(folder / "rod_forces.csv"));
    tables.add(run.trajectory, d, 3, 7);  // of a run that is killed behind its last checkpoint
    tables.cut(three);
    CHECK(std::filesystem::file_size(folder / "trajectory.csv") == three.trajectory);
    tables.add(run.trajectory, d, 3, 5);
    tables.flush_to_disk();
  }
  RunTables(folder).add(run.trajectory, d, 5, states);  // another program goes on
  const TemporaryFile whole;
  const auto text = [](const std::filesystem::path& path) {
    std::ostringstream out;
    out << std::ifstream(path, std::ios::binary).rdbuf();
    return out.str();
  };
  write_series_csv(whole.path, d);
  CHECK(text(folder / "series.csv") == text(whole.path));
  write_trajectory_csv(whole.path, run.trajectory);
  CHECK(text(folder / "trajectory.csv") == text(whole.path));
  write_rod_forces_csv(whole.path, run.trajectory, d);
  CHECK(text(folder / "rod_forces.csv") == text(whole.path));
  std::filesystem::remove_all(folder);
}

TEST_CASE("cells that would break the table are quoted") {
  CHECK(csv_cell("plain") == "plain");
  CHECK(csv_cell("a,b") == "\"a,b\"");
  CHECK(csv_cell("say \"x\"\n") == "\"say \"\"x\"\"\n\"");
  CHECK(csv_cell("#ff8800") == "\"#ff8800\"");  // no comment
  CHECK(csv_cell("n#1") == "n#1");
  CHECK(csv_cell("two ") == "\"two \"");
}

TEST_CASE("a directory that is not there is a file error") {
  const Simulation run = short_run("double_pendulum", {"solver.end_time=0.02"});
  CHECK_THROWS_AS(write_trajectory_csv("/nowhere/t.csv", run.trajectory), FileError);
}

// A table remembers the text of numbers that it wrote: 40 000 cells in which few, many and none come again,
// with either sign, of every size, against the shortest text of each.
TEST_CASE("every number in a table is its own shortest text, however often it came before") {
  Diagnostics d;
  d.columns = {{"a", "", "", {}}, {"b", "", "", {}}, {"c", "", "", {}}, {"d", "", "", {}}};
  std::uint64_t bits = 0x243f6a8885a308d3ULL;
  const auto next = [&bits] {
    double x = 0;
    do {
      bits = bits * 6364136223846793005ULL + 1442695040888963407ULL;
      x = std::bit_cast<double>(bits);
    } while (!std::isfinite(x) || x == 0);
    return x;
  };
  std::vector<double> few;
  for (int i = 0; i < 700; ++i) few.push_back(next());
  for (std::size_t i = 0; i < 10000; ++i) {
    d.t.push_back(static_cast<double>(i));
    const double x = few[bits % few.size()];
    d.columns[0].values.push_back(next());
    d.columns[1].values.push_back(x);
    d.columns[2].values.push_back(-x);
    d.columns[3].values.push_back(i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : 0.0);
  }
  const TemporaryFile file;
  write_series_csv(file.path, d);
  const auto rows = table(file.path);
  REQUIRE(rows.size() == d.t.size() + 1);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < d.t.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c) {
      char text[32];
      const double x = d.columns[c].values[i];
      const std::string shortest(text, std::to_chars(text, text + sizeof text, x).ptr);
      if (rows[i + 1][c + 1] != shortest) ++wrong;
    }
  CHECK(wrong == 0);
}

}  // namespace csv_test
