// SPDX-License-Identifier: BSD-3-Clause
// A test whose name the list of tests cannot carry is one that never runs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace test_names_test {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// What stands between quotes behind `at`, literals in a row joined.
std::string literal(const std::string& text, std::size_t at) {
  std::string joined;
  while ((at = text.find_first_not_of(" \n", at)) != std::string::npos && text[at] == '"') {
    const std::size_t end = text.find('"', at + 1);
    joined += text.substr(at + 1, end - at - 1);
    at = end + 1;
  }
  return joined;
}

}  // namespace

TEST_CASE("names of tests can be listed and picked one by one") {
  const std::string head = "\nTEST_CASE(";
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(UNFURL_ROOT) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::size_t at = text.find(head); at != std::string::npos; at = text.find(head, at + 1)) {
      const std::string name = literal(text, at + head.size());
      INFO(entry.path().filename().string() << ": " << name);
      REQUIRE_FALSE(name.empty());
      CHECK(name.find(';') == std::string::npos);  // CMake splits lists there; the halves match no test
      CHECK(name.find('\\') == std::string::npos);
      CHECK(name[0] != '-');  // an option
      CHECK(names.insert(name).second);
    }
  }
  CHECK(names.size() > 500);
}

}  // namespace test_names_test
