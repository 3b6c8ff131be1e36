// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets share: each says what to try with a text; an exception that gets out is a finding.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace unfurl::fuzz {

void try_text(std::string_view text);  // one for each target

// Ends the program where it is false, as a finding.
void require(bool holds, const char* what);

// Sizes of more than one digit are slow, not interesting.
bool large_structure(std::string_view text);

std::vector<std::string> lines_of(std::string_view text);

// A file of that content in a directory of this process.
class ScratchFile {
 public:
  ScratchFile(const char* name, std::string_view content);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace unfurl::fuzz
