// SPDX-License-Identifier: BSD-3-Clause
// Two types of one name in one namespace are one to the linker, which takes the functions of either for both.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace type_names_test {

namespace fs = std::filesystem;

TEST_CASE("no two types of a namespace have one name") {
  const std::regex type(R"(^(?:struct|class|enum|enum class) (\w+)(?: final)?(?: :[^;]*)?(?: \{.*)?$)"),
      space(R"(^namespace (\S+) \{.*$)");
  std::map<std::string, std::vector<std::string>> places;
  for (const char* folder : {"core", "render", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(UNFURL_ROOT) / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      std::ifstream file(entry.path());
      std::vector<std::string> spaces;
      std::smatch match;
      for (std::string line; std::getline(file, line);) {
        if (line == "namespace {") {
          spaces.emplace_back();
        } else if (std::regex_match(line, match, space)) {
          spaces.push_back(match[1]);
        } else if (line.starts_with("}  // namespace")) {
          if (!spaces.empty()) spaces.pop_back();
        } else if (std::regex_match(line, match, type)) {
          std::string name;
          for (const std::string& within : spaces) name += within + "::";
          if (name.find("::::") == std::string::npos && name.front() != ':')  // in no anonymous one
            places[name + match[1].str()].push_back(entry.path().string());
        }
      }
    }
  CHECK(places.size() > 300);
  for (const auto& [name, files] : places) {
    INFO(name << " in " << files.front() << " and " << files.back());
    CHECK(files.size() == 1);
  }
}

}  // namespace type_names_test
