// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/export/atomic_file.hpp"
#include "core/study/journal.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace journal_test {

namespace {

struct File {
  fs::path path = fs::temp_directory_path() / ("unfurl_journal_test_" + std::to_string(::getpid()) + ".csv");
  File() { fs::remove(path); }
  ~File() { fs::remove(path); }
};

}  // namespace

TEST_CASE("a journal finds what an earlier one wrote") {
  const File file;
  {
    Journal journal(file.path, {"name", "n", "value"}, 2);
    journal.append({"a, b", "1", "0.5"});
    journal.append({"a, b", "2", "0.25"});
  }
  const Journal again(file.path, {"name", "n", "value"}, 2);
  CHECK(again.size() == 2);
  REQUIRE(again.find({"a, b", "2"}));
  CHECK((*again.find({"a, b", "2"}))[2] == "0.25");
  CHECK(again.find({"a, b", "3"}) == nullptr);
}

TEST_CASE("a line that a kill left torn is dropped") {
  const File file;
  { Journal(file.path, {"n", "value"}, 1).append({"1", "0.5"}); }
  std::ofstream(file.path, std::ios::app) << "2,0.2";  // no line break
  {
    Journal journal(file.path, {"n", "value"}, 1);
    CHECK(journal.size() == 1);
    journal.append({"2", "0.25"});
  }
  CHECK((*Journal(file.path, {"n", "value"}, 1).find({"2"}))[1] == "0.25");
}

// The second of two would begin with the rows that it finds, under the file's name, and the first one would
// go on with a file that has none.
TEST_CASE("a journal that is being written is not opened by another") {
  const File file;
  {
    Journal first(file.path, {"n", "value"}, 1);
    first.append({"1", "0.5"});
    CHECK_THROWS_AS(Journal(file.path, {"n", "value"}, 1), FileError);
    CHECK_THROWS_AS(Journal::require_free(file.path), FileError);
    first.append({"2", "0.25"});
  }
  Journal::require_free(file.path);
  CHECK(Journal(file.path, {"n", "value"}, 1).size() == 2);
}

TEST_CASE("rows of another length are no results") {
  const File file;
  { Journal(file.path, {"n", "value", "unit"}, 1).append({"1", "0.5", "m"}); }
  std::ofstream(file.path, std::ios::app) << "2,0.25\n3,0.125,m,4,0.06,m\n5,0.03,m\n";
  const Journal journal(file.path, {"n", "value", "unit"}, 1);
  CHECK(journal.size() == 2);
  CHECK(journal.find({"5"}));
  CHECK_FALSE(journal.find({"3"}));
}

TEST_CASE("of a result that was appended twice the later one stays, in the file as in memory") {
  const File file;
  {
    Journal journal(file.path, {"n", "value"}, 1);
    journal.append({"1", "0.5"});
    journal.append({"1", "0.25"});
    CHECK((*journal.find({"1"}))[1] == "0.25");
  }
  CHECK((*Journal(file.path, {"n", "value"}, 1).find({"1"}))[1] == "0.25");
}

TEST_CASE("a journal finds keys of any text") {
  const std::vector<std::string> keys = {"#ff8800", " # 1", "two ", "\tthree", "a \"b\"",
                                         "c\nd",    "\"",   "e\r",  ""};
  const File file;
  {
    Journal journal(file.path, {"colour", "value"}, 1);
    for (const std::string& key : keys) journal.append({key, key + "!"});
  }
  for (int again = 0; again < 2; ++again) {  // the second reads what the first has written anew
    const Journal journal(file.path, {"colour", "value"}, 1);
    CHECK(journal.size() == keys.size());
    for (const std::string& key : keys) {
      INFO(key);
      REQUIRE(journal.find({key}));
      CHECK((*journal.find({key}))[1] == key + "!");
    }
  }
}

TEST_CASE("a result torn within quotes is dropped") {
  const File file;
  { Journal(file.path, {"n", "value"}, 1).append({"1", "0.5"}); }
  std::ofstream(file.path, std::ios::app) << "2,\"two\nlines";  // torn behind the break
  CHECK(Journal(file.path, {"n", "value"}, 1).find({"2"}) == nullptr);
}

TEST_CASE("rows that no work leaves are no results and are told of with their line") {
  const File file;
  const std::vector<std::string> columns = {"n", "value"};
  const auto read = [&] {
    return Journal(file.path, columns, 1, {1}, [](const Journal::Row& row) { return row[1] != "-1"; });
  };
  { Journal(file.path, columns, 1).append({"1", "0.5"}); }
  CHECK(read().damage().empty());
  std::ofstream(file.path, std::ios::app) << "2,-1\n3,0.25\n4,abc\n5,6,7\n8,0.1";  // the last is torn
  {
    const Journal journal = read();
    CHECK(journal.size() == 2);
    CHECK_FALSE(journal.find({"2"}));
    CHECK(journal.find({"3"}));
    CHECK(journal.damage() == std::vector<std::string>{file.path.string() +
                                                       ": 3 lines, the first of them line 3, are no finished "
                                                       "results"});
  }
  CHECK(read().damage().empty());  // the file was written without them
  std::ofstream(file.path, std::ios::app) << "2,-1\n";
  CHECK(read().damage() == std::vector<std::string>{file.path.string() + ": line 4 is no finished result"});
}

TEST_CASE("a journal of other columns is refused") {
  const File file;
  { Journal(file.path, {"n", "value"}, 1).append({"1", "0.5"}); }
  CHECK_THROWS_AS(Journal(file.path, {"n", "other"}, 1), JournalMismatch);
}

}  // namespace journal_test
