// SPDX-License-Identifier: BSD-3-Clause
// After every verb: what it wrote, where, how large.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "core/export/atomic_file.hpp"

namespace unfurl {

// 999 B, 1.0 kB, 12.3 MB: powers of a thousand.
std::string bytes_text(std::uintmax_t bytes);

// While it lives it is told of every file that appears in `output`, or beside it where that is a file.
class WrittenReport final : public FileWatcher {
 public:
  explicit WrittenReport(std::filesystem::path output);  // empty: of nothing
  ~WrittenReport();
  WrittenReport(const WrittenReport&) = delete;
  WrittenReport& operator=(const WrittenReport&) = delete;

  void before_file(const std::filesystem::path& target, const std::string& checksum) override;

  // A line with the sum and lines with the files, folders as one; empty: nothing was written that still is
  // there.
  std::string text() const;

 private:
  std::filesystem::path output_;
  mutable std::mutex mutex_;
  std::set<std::filesystem::path> files_;
  FileWatcher* before_;
};

}  // namespace unfurl
