// SPDX-License-Identifier: BSD-3-Clause
// The tables of a run that is written while it goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// series.csv, trajectory.csv and rod_forces.csv in a folder, as csv.hpp writes them. All throw FileError.
class RunTables {
 public:
  struct Sizes {  // of the files [bytes]
    std::uint64_t series = 0, trajectory = 0, rod_forces = 0;
    void archive(Archive& a) { a(series), a(trajectory), a(rod_forces); }
  };
  explicit RunTables(const std::filesystem::path& folder);  // makes the files where they are missing
  ~RunTables();
  RunTables(const RunTables&) = delete;
  RunTables& operator=(const RunTables&) = delete;

  // The rows of these states; with a header in front where the files are empty.
  void add(const Trajectory& trajectory, const Diagnostics& diagnostics, std::size_t first, std::size_t last);
  Sizes sizes();          // of all that was added
  void cut(Sizes sizes);  // drops what is behind them
  void flush_to_disk();

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

// Gives whole files their names in another directory, as commit_together(): completed, entered in the list of
// what was written, then all at one moment, `before` which something may be done.
void move_into_place(const std::filesystem::path& from, std::span<const std::string> names,
                     const std::filesystem::path& to, const std::function<void()>& before);

}  // namespace unfurl
