// SPDX-License-Identifier: BSD-3-Clause
// Finished results on disk, one line each, written as they come: what is in the file need not be computed
// again.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>

#include "core/study/table.hpp"
#include "core/text/error.hpp"

namespace unfurl {

// The file holds other results than asked for: another scene or other settings.
struct JournalMismatch : Error {
  using Error::Error;
};

// A CSV file of rows whose first `keys` cells say which result it is. Lines are appended whole; one that a
// kill or a full disk left torn is dropped at the next opening. An empty path keeps nothing.
class Journal {
 public:
  using Row = std::vector<std::string>;
  // Reads what is there; a row whose cells in the columns `numbers` (indices) are not all numbers, or that
  // `finished` does not take, is no result. Throws JournalMismatch where its columns are others, FileError,
  // also where another journal writes to the file: one of them would lose what it has computed.
  // With `make_room` what is there is not read and stays until a first new result is on the disk under
  // another name; make_room() then takes it away.
  Journal(std::filesystem::path path, std::vector<std::string> columns, std::size_t keys,
          std::vector<std::size_t> numbers = {}, std::function<bool(const Row&)> finished = {},
          std::function<void()> make_room = {});
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Throws FileError where a journal of another process writes to this file.
  static void require_free(const std::filesystem::path& path);

  const std::vector<std::string>* find(const std::vector<std::string>& key) const;
  void append(std::vector<std::string> row);  // throws FileError
  // The results in another journal of the same columns, which may be growing, beside what is here; the file
  // does not get them. Throws JournalMismatch, FileError.
  void take_in(const std::filesystem::path& other);
  void take_in(const std::vector<std::filesystem::path>& others) {
    for (const auto& other : others) take_in(other);
  }
  std::size_t size() const { return rows_.size(); }
  // Throws FileError, with what can be done, where there are results that `asked` does not take: a command
  // that asks for fewer than an earlier one would write over them.
  void require_asked(const std::function<bool(const Row&)>& asked, const std::filesystem::path& directory,
                     const std::string& cure) const;
  // Of each file that was read with whole lines that are no results: "DIR/sweep.csv: line 3 is no finished
  // result".
  std::vector<std::string> damage() const;

 private:
  bool is_result(const Row& row) const;
  void begin_file();

  std::filesystem::path path_;
  std::vector<std::string> columns_;
  std::size_t keys_;
  std::vector<std::size_t> numbers_;
  std::function<bool(const Row&)> finished_;
  std::function<void()> make_room_;
  struct Damage {
    std::size_t lines = 0, first = 0;
  };
  std::map<std::filesystem::path, Damage> damage_;
  std::map<std::vector<std::string>, std::vector<std::string>> rows_;
  std::FILE* file_ = nullptr;
};

}  // namespace unfurl
