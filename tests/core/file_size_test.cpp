// SPDX-License-Identifier: BSD-3-Clause
// No source file grows past what can be read in one sitting, and none hides behind a name that means nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace file_size_test {

namespace {

namespace fs = std::filesystem;

struct Source {
  std::string path;
  std::size_t lines;
};

std::vector<Source> sources() {
  std::vector<Source> found;
  const fs::path root = UNFURL_ROOT;
  for (const char* folder : {"core", "render", "app", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      std::ifstream file(entry.path());
      std::size_t lines = 0;
      for (std::string line; std::getline(file, line);) ++lines;
      found.push_back({fs::relative(entry.path(), root).string(), lines});
    }
  }
  return found;
}

}  // namespace

TEST_CASE("no source file is longer than 500 lines") {
  for (const auto& source : sources()) {
    INFO(source.path);
    CHECK(source.lines <= 500);
  }
}

TEST_CASE("the median source file is short") {
  auto all = sources();
  REQUIRE(all.size() > 50);
  std::sort(all.begin(), all.end(), [](const Source& a, const Source& b) { return a.lines < b.lines; });
  CHECK(all[all.size() / 2].lines <= 180);
}

TEST_CASE("no file has a name that says nothing") {
  for (const auto& source : sources()) {
    INFO(source.path);
    const std::string stem = fs::path(source.path).stem().string();
    for (const char* empty : {"utils", "util", "helpers", "helper", "common", "manager", "misc"})
      CHECK(stem.find(empty) == std::string::npos);
  }
}

}  // namespace file_size_test
