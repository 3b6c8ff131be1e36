// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz.hpp"

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace unfurl::fuzz {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

bool large_structure(std::string_view text) {
  for (const char* key : {"units", "cells", "rows", "columns", "links", "windows", "sides"}) {
    const auto at = text.find(key);
    if (at == text.npos) continue;
    int digits = 0;
    for (const char c : text.substr(at, 30)) digits += c >= '0' && c <= '9';
    if (digits > 1) return true;
  }
  return text.size() > 6000;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines = {""};
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  return lines;
}

ScratchFile::ScratchFile(const char* name, std::string_view content) {
  const auto folder = std::filesystem::temp_directory_path() / ("unfurl_fuzz_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  path_ = folder / name;
  std::ofstream(path_, std::ios::binary) << content;
}

ScratchFile::~ScratchFile() {
  std::error_code ignored;
  std::filesystem::remove_all(path_.parent_path(), ignored);
}

}  // namespace unfurl::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  unfurl::fuzz::try_text({reinterpret_cast<const char*>(data), size});
  return 0;
}
