// SPDX-License-Identifier: BSD-3-Clause
// Results that were kept, put together and judged again.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/study/stress.hpp"
#include "core/study/study.hpp"
#include "core/study/sweep.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace kept_results_test {

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("unfurl_kept_results_" + std::to_string(::getpid()));
  Folder() { fs::remove_all(path), fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

// Six points, of which nothing is run.
SweepPlan grid() {
  SweepPlan plan;
  plan.source = {"s.toml", {}, std::make_shared<const std::string>("[structure]\nkind = 'pendulum'\n")};
  plan.axes = {parse_axis("structure.length=1.5,2.5,3.5"), parse_axis("structure.bob_mass=4,5")};
  plan.measures = {find_measure("end_time"), find_measure("cpu")};
  return plan;
}

using Rows = std::vector<std::vector<std::string>>;

fs::path journal_of(const SweepPlan& plan, const fs::path& path, const Rows& rows) {
  Journal journal(path, plan.columns(), plan.axes.size());
  for (const auto& row : rows) journal.append(row);
  return path;
}

}  // namespace

TEST_CASE("merged journals hold each point once, the first that has it, and tell where they differ") {
  const Folder folder;
  SweepPlan plan = grid();
  plan.shard = {2, 3};  // of no matter: all that is there is put together
  const Rows first = {{"1.5", "4", "completed", "0.5", "0.25"}, {"1.5", "5", "completed", "0.5", "0.375"}};
  const Rows second = {{"1.5", "5", "completed", "0.5", "0.625"},  // of another time, which tells nothing
                       {"2.5", "4", "completed", "0.75", "0.125"},
                       {"3.5", "5", "failed", "nan", "nan"}};
  const Rows third = {{"1.5", "4", "completed", "0.625", "0.25"},
                      {"3.5", "5", "invalid", "nan", "nan"},
                      {"2.5", "4", "completed", "0.75", "0.25"}};
  const fs::path a = journal_of(plan, folder.path / "a.csv", first),
                 b = journal_of(plan, folder.path / "b.csv", second),
                 c = journal_of(plan, folder.path / "c.csv", third);
  std::ofstream(b, std::ios::app) << "2.5,5,gone,1,1\n";
  fs::permissions(b, fs::perms::owner_read);  // another may be writing into it: nothing of it is changed
  const auto written = fs::last_write_time(b);
  const Sweep whole = merge_sweep(plan, {a, b, c});
  CHECK(fs::last_write_time(b) == written);
  CHECK(whole.table.columns == plan.columns());
  CHECK(whole.table.rows == Rows{first[0], first[1], second[1], second[2]});
  CHECK(whole.missing == std::vector<std::size_t>{3, 4});
  CHECK(unanswered(plan, whole) == 1);
  const auto apart = [](const char* point, const fs::path& one, const fs::path& two) {
    return std::string(point) + ": " + one.string() + " and " + two.string() +
           " disagree; the first was taken";
  };
  CHECK(whole.conflicts ==
        std::vector<std::string>{apart("structure.length=1.5, structure.bob_mass=4", a, c),
                                 apart("structure.length=3.5, structure.bob_mass=5", b, c),
                                 b.string() + ": line 5 is no finished result and was left out"});
  // The other way round the others are the first.
  const Sweep back = merge_sweep(plan, {c, b});
  CHECK(back.table.rows == Rows{third[0], second[0], third[2], third[1]});
  CHECK(back.conflicts ==
        std::vector<std::string>{apart("structure.length=3.5, structure.bob_mass=5", c, b),
                                 b.string() + ": line 5 is no finished result and was left out"});
}

TEST_CASE("last digits of a path that was traced from elsewhere are no disagreement") {
  const Folder folder;
  const SweepPlan plan = grid();
  const fs::path a = journal_of(plan, folder.path / "a.csv",
                                {{"1.5", "4", "completed", "0.18228695080610516", "0.25"}}),
                 b = journal_of(plan, folder.path / "b.csv",
                                {{"1.5", "4", "completed", "0.18228695080610602", "0.25"}}),
                 c = journal_of(plan, folder.path / "c.csv", {{"1.5", "4", "completed", "0.182287", "0.25"}});
  CHECK(merge_sweep(plan, {a, b}).conflicts.empty());
  CHECK(merge_sweep(plan, {a, c}).conflicts.size() == 1);
}

TEST_CASE("points without an answer are counted, by their outcome") {
  const SweepPlan plan = grid();
  Sweep sweep;
  for (const char* outcome : {"failed", "completed", "invalid", "deployed", "invalid"})
    sweep.table.rows.push_back({"failed", "invalid", outcome, "failed", "invalid"});
  CHECK(unanswered(plan, sweep) == 3);
}

// Of two points that no scene takes, the first in the grid speaks, whichever is computed first.
TEST_CASE("a sweep says why its first point has no answer") {
  SweepPlan plan;
  plan.source = {
      "s.toml",
      {},
      std::make_shared<const std::string>("[structure]\nkind = 'pendulum'\n[solver]\nend_time = 0.1\n")};
  plan.axes = {parse_axis("structure.length=1.25,-2,0.5,-3")};
  plan.measures = {find_measure("end_time")};
  check_plan(plan);
  for (const bool known : {false, true}) {
    Journal journal({}, plan.columns(), plan.axes.size());
    if (known) journal.append({"-2", "invalid", "nan"});
    const Sweep sweep = run_sweep(plan, journal, {});
    REQUIRE(sweep.table.rows.size() == 4);
    CHECK(sweep.table.rows[0] == std::vector<std::string>{"1.25", "completed", "0.1"});
    CHECK(sweep.table.rows[3] == std::vector<std::string>{"-3", "invalid", "nan"});
    CHECK(unanswered(plan, sweep) == 2);
    REQUIRE(sweep.why.size() == 1);
    CHECK(sweep.why.begin()->first == "invalid");
    CHECK(sweep.why.begin()->second.starts_with(known ? "structure.length=-3: " : "structure.length=-2: "));
    CHECK(sweep.missing.empty());
    CHECK(sweep.moved.empty());
  }
}

TEST_CASE("a study asks for rows of its settings and steps alone") {
  StudyPlan plan;
  plan.settings.resize(2);
  plan.settings[0].name = "dvm s=3";
  plan.settings[1].name = "rk4";
  plan.ladder.steps = {35, 70};
  for (const auto& [name, steps, asked] : {std::tuple{"dvm s=3", "35", true},
                                           {"rk4", "70", true},
                                           {"rk4", "35", true},
                                           {"rk4", "140", false},
                                           {"dvm s=4", "70", false},
                                           {"35", "rk4", false},
                                           {"rk4", "7", false}})
    CHECK(asks_for(plan, {name, steps, "rk4", "35"}) == asked);
}

TEST_CASE("a journal is not asked for less than it holds without a word") {
  const Folder folder;
  const SweepPlan all = grid();
  SweepPlan fewer = grid();
  fewer.axes[0] = parse_axis("structure.length=1.5,3.5");
  Journal journal(
      journal_of(all, folder.path / "j.csv",
                 {{"1.5", "5", "completed", "0.5", "0.375"}, {"2.5", "4", "completed", "0.5", "0.375"}}),
      all.columns(), 2);
  CHECK_NOTHROW(journal.require_asked(all.asked(), folder.path, "take them"));
  CHECK_THROWS_WITH(journal.require_asked(fewer.asked(), folder.path, "take them"),
                    Catch::Contains("holds 1 result that is not asked for now and would be lost; take them"));
  fewer.axes[1] = parse_axis("structure.bob_mass=4");
  CHECK_THROWS_WITH(journal.require_asked(fewer.asked(), folder.path, "go"),
                    Catch::Contains("holds 2 results that are not asked for now and would be lost; go"));
}

TEST_CASE("a cell of an atlas is one that a run may leave") {
  StressCell cell{"force", 2.5, "dvm s=3", 64, Verdict::right, {}};
  cell.run.step = 0.02, cell.run.position_error = 1e-5, cell.run.constraint_relative_max = 1e-13;
  cell.run.energy_error = 0.3, cell.run.kinetic_energy_max = 8, cell.run.cpu_median = 0.04;
  Stress stress;
  stress.cells = {cell};
  const Table table = cells_table(stress);
  const auto with = [&](const char* column, const char* text, const char* verdict = "right") {
    std::vector<std::string> row = table.rows.at(0);
    row[table.column("verdict")] = verdict;
    row[table.column(column)] = text;
    return is_stress_cell(row);
  };
  CHECK(is_stress_cell(table.rows[0]));
  for (const Verdict v : verdicts()) CHECK(with("message", "said", std::string(to_string(v)).c_str()));
  CHECK_FALSE(with("message", "said", "rihgt"));
  for (const char* time : {"step_s", "cpu_s"}) {
    INFO(time);
    CHECK(with(time, "0"));
    for (const char* bad : {"-1", "nan", "inf"}) CHECK_FALSE(with(time, bad, "too slow"));
  }
  for (const char* error :
       {"position_error_m", "constraint_relative_max", "energy_error_max_J", "kinetic_energy_max_J"}) {
    INFO(error);
    CHECK(with(error, "0"));
    for (const char* unknown : {"nan", "inf"}) {
      CHECK_FALSE(with(error, unknown));
      CHECK(with(error, unknown, "solver failed"));
    }
    for (const char* verdict : {"right", "solver failed"}) CHECK_FALSE(with(error, "-1e-9", verdict));
  }
}

TEST_CASE("a scene that was studied is told as it was read, with what was set") {
  const SceneSource source{
      "mast.toml",
      {"structure.length=2", "title=\"a \\\"b\\\"\""},
      std::make_shared<const std::string>(
          "title = \"mast\"\n[structure]\nkind = 'pendulum'\nlength = 1.5\nbob_mass = 3\n"
          "[[forces]]\nkind = 'drag'\nnodes = ['bob', 'O']\nenabled = false\n")};
  CHECK(unexpanded_text(source) ==
        "# \"title\" = \"mast\"\n"
        "# \"structure\" = {\"kind\" = \"pendulum\", \"length\" = 1.5, \"bob_mass\" = 3}\n"
        "# \"forces\" = [{\"kind\" = \"drag\", \"nodes\" = [\"bob\", \"O\"], \"enabled\" = false}]\n"
        "# --set \"structure.length=2\"\n# --set \"title=\\\"a \\\\\\\"b\\\\\\\"\\\"\"\n");
}

}  // namespace kept_results_test
