// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/csv_table.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/study/table.hpp"

using namespace unfurl;

namespace csv_table_test {

namespace {

const std::vector<CsvColumn> columns = {{"name", "", false, true},
                                        {"x", "m", true, true},
                                        {"mass", "kg", true},
                                        {"fixed", "", true, false, true}};

// All that is wrong, each on a line: "line: key what".
std::vector<std::string> wrong(const std::string& text) {
  SceneNotes notes;
  read_csv(text, "n.csv", columns, notes);
  std::vector<std::string> out;
  for (const SceneProblem& problem : notes.problems) {
    CHECK(problem.where.file == "n.csv");
    out.push_back(std::to_string(problem.where.line) + ": " + (problem.key.empty() ? "" : problem.key + " ") +
                  problem.message);
  }
  return out;
}

using Rows = std::vector<std::vector<std::string>>;
using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("records of any cells are read as they were written") {
  std::mt19937 dice(4180);
  const std::string letters = "ab,\"\n\r #\t1";
  for (int trial = 0; trial < 500; ++trial) {
    Rows rows(1 + dice() % 4);
    const std::size_t width = 1 + dice() % 4;
    for (auto& row : rows)
      for (std::size_t c = 0; c < width; ++c) {
        std::string cell;
        for (std::size_t k = dice() % 6; k > 0; --k) cell += letters[dice() % letters.size()];
        row.push_back(width == 1 && cell.empty() ? "x" : cell);  // a line of nothing is none
      }
    std::string text;
    for (const auto& row : rows) text += (trial % 3 ? "" : "\n# a remark, \"\n") + csv_line(row);
    if (trial % 2) text.pop_back();  // the last line break may be missing
    CAPTURE(text);
    CHECK(csv_records(text) == rows);
  }
  CHECK(csv_records("a , \"b\" ,\tc\r\n\r\n  d,e  ,\r\n") == Rows{{"a", "b", "c"}, {"d", "e", ""}});
  CHECK(csv_records("a,\"b\nc") == Rows{});
  CHECK(csv_records("a,b\nc,\"d") == Rows{{"a", "b"}});
  CHECK(csv_records("\"a\"\"b\"") == Rows{{"a\"b"}});
  CHECK(csv_records("") == Rows{});
}

TEST_CASE("rows of a table come with their place, their texts and their numbers") {
  SceneNotes notes;
  const auto rows = read_csv(
      "\xEF\xBB\xBF# nodes\n\nfixed,x_m,name\ntrue,+1.5,A\n# one more\n \t\n  "
      "\r\n0,-2e3,\"B\nb\"\n,0,C\nfalse,7,D",
      "n.csv", columns, notes);
  CHECK(notes.problems.empty());
  REQUIRE(rows.size() == 4);
  const int lines[] = {4, 8, 10, 11};
  const char* names[] = {"A", "B\nb", "C", "D"};
  const double x[] = {1.5, -2000, 0, 7}, fixed[] = {1, 0, -1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(rows[i].where.line == lines[i]);
    CHECK(rows[i].where.column == 1);
    CHECK(rows[i].where.file == "n.csv");
    CHECK(rows[i].texts.at("name") == names[i]);
    CHECK(rows[i].numbers.at("x") == x[i]);
    CHECK_FALSE(rows[i].numbers.contains("mass"));
    CHECK(rows[i].numbers.contains("fixed") == (i != 2));
    if (i != 2) CHECK(rows[i].numbers.at("fixed") == fixed[i]);
  }
}

TEST_CASE("all that is wrong with a table is listed, and nothing else") {
  CHECK(wrong("name,x\nA,1\n") == Texts{});
  CHECK(wrong("name,x,mas,mass,mass_kg\nA,1,2,3,4\n") ==
        Texts{"1: unknown column 'mas'; did you mean 'mass'?", "1: column 'mass_kg' appears twice"});
  CHECK(wrong("\nmass\n1\n") == Texts{"2: column 'name' is missing", "2: column 'x' is missing"});
  for (const char* nothing : {"", "# only\n\n"})
    CHECK(wrong(nothing) == Texts{"1: is empty; the first line must name the columns"});
  CHECK(wrong("name,x,fixed\nA,1\nB,,yes\nC,1m,true\nD,2,1,5\nE,inf,0\nF,3,1\nG,3,\"t\n") ==
        Texts{"2: has 2 cells; the header has 3", "3: x is empty",
              "3: fixed must be true or false; got 'yes'", "4: x must be a finite number; got '1m'",
              "5: has 4 cells; the header has 3", "6: x must be a finite number; got 'inf'",
              "8: has a quote that is not closed"});
  CHECK(wrong("name,x\n\"A\"B,1\n\"A\" \t,+1\nB,+-1\nC,-+1\nD,+\n") ==
        Texts{"2: has text behind a closing quote", "4: x must be a finite number; got '+-1'",
              "5: x must be a finite number; got '-+1'", "6: x must be a finite number; got '+'"});
  CHECK(wrong("name,x\n\"A\"B,1").front() == "2: has text behind a closing quote");
  CHECK(wrong("name,x\n\"A\"B,1\n\"#1\",2\n#1,2\n").size() == 1);
  CHECK(wrong("name,x\nA,1\n\"\xFF\",2\n").size() == 1);
  CHECK(wrong("name,x\nA,1\n\"\xFF\",2\n")[0].starts_with("3: "));
}

// Followed to the letter, the name of another column would take 250 g for 250 kg.
TEST_CASE("a column with another unit is told the unit and not a name") {
  for (const char* other : {"mass_g", "mass_grams", "mass (kg)", "mass [g]"})
    CHECK(wrong(std::string("name,x,") + other + "\nA,1,250\n") ==
          Texts{std::string("1: unknown column '") + other +
                "'; give 'mass_kg', with the values converted to that unit"});
  CHECK(wrong("name,x_mm\nA,1\n") ==
        Texts{"1: unknown column 'x_mm'; give 'x_m', with the values converted to that unit",
              "1: column 'x' is missing"});
  CHECK(wrong("name,x,fixed_x\nA,1,1\n").front().find("convert") == std::string::npos);  // it has no unit
}

TEST_CASE("numbers too large and too small for a double are told so") {
  for (const char* number : {"1e-400", "1e400", "-1e999"})
    CHECK(wrong(std::string("name,x\nA,") + number + "\n") ==
          Texts{std::string("2: x must be 0 or of a size between 1e-307 and 1e308; got '") + number + "'"});
}

}  // namespace csv_table_test
