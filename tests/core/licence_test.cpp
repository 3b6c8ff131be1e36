// SPDX-License-Identifier: BSD-3-Clause
// Every source file names the licence that it is under, in its first two lines (the first may be "#!").
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

namespace licence_test {

namespace fs = std::filesystem;

bool names_its_licence(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  for (int i = 0; i < 2 && std::getline(file, line); ++i)
    if (line.ends_with("SPDX-License-Identifier: BSD-3-Clause")) return true;
  return false;
}

bool is_source(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".cpp" || extension == ".hpp" || extension == ".h" || extension == ".py" ||
         extension == ".sh" || path.filename() == "CMakeLists.txt";
}

TEST_CASE("every source file names its licence") {
  const fs::path root = UNFURL_ROOT;
  int files = 0;
  for (const char* folder : {"core", "render", "app", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      INFO(fs::relative(entry.path(), root).string());
      CHECK(names_its_licence(entry.path()));
      ++files;
    }
  CHECK(files > 400);  // the walk did not miss the tree
  for (const char* file : {"CMakeLists.txt", "dev", ".ci/run"}) {
    INFO(file);
    CHECK(names_its_licence(root / file));
  }
  std::ifstream licence(root / "LICENSE");
  std::string first;
  std::getline(licence, first);
  CHECK(first == "BSD 3-Clause License");
}

}  // namespace licence_test
