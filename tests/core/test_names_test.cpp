// A test whose name the list of tests cannot carry is one that never runs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
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

}  // namespace

TEST_CASE("names of tests can be listed and picked one by one") {
  // The name may be several literals in a row, each on a line of its own.
  const std::regex head(R"rx(\nTEST_CASE\(\s*("[^"\n]*"(\s*"[^"\n]*")*))rx"), seam("\"\\s*\"");
  std::set<std::string> names;
  int found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(UNFURL_ROOT) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), head), end; it != end; ++it) {
      const std::string name = std::regex_replace((*it)[1].str(), seam, "");
      INFO(entry.path().filename().string() << ": " << name);
      ++found;
      CHECK(name.find(';') == std::string::npos);  // CMake splits lists there; the halves match no test
      CHECK(name.find('\\') == std::string::npos);
      CHECK(name[1] != '-');  // an option
      CHECK(names.insert(name).second);
    }
  }
  CHECK(found > 500);
}

}  // namespace test_names_test
