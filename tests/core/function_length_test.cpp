// SPDX-License-Identifier: BSD-3-Clause
// No function is longer than what can be read at a glance, every header can be compiled alone, and folders
// point in one direction.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace function_length_test {

namespace {

namespace fs = std::filesystem;

struct Source {
  std::string path;  // from the root
  std::vector<std::string> lines;
};

const std::vector<Source>& sources() {
  static const std::vector<Source> found = [] {
    std::vector<Source> list;
    const fs::path root = UNFURL_ROOT;
    for (const char* folder : {"core", "render", "app", "tests"})
      for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        const auto extension = entry.path().extension();
        if (extension != ".cpp" && extension != ".hpp") continue;
        Source source{fs::relative(entry.path(), root).string(), {}};
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) source.lines.push_back(line);
        list.push_back(std::move(source));
      }
    return list;
  }();
  return found;
}

// As clang-format lays code out: a body opens at the end of a line and closes with a line that is as far in.
// Bodies of classes and namespaces are not those of functions.
std::string long_functions(const Source& source) {
  std::string text;
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const std::string& line = source.lines[i];
    const std::size_t in = line.find_first_not_of(' ');
    if (in == std::string::npos || in > 4 || !line.ends_with("{")) continue;
    const bool function = line.ends_with(") {") || line.ends_with(") const {") ||
                          line.ends_with("override {") || line.ends_with("noexcept {") ||
                          line.starts_with("TEST_CASE");
    if (!function) continue;
    const auto closes = [&](const std::string& later) {  // as far in, or where a long head began
      const std::size_t at = later.find_first_not_of(' ');
      return at <= in && later[at] == '}';
    };
    std::size_t end = i + 1;
    while (end < source.lines.size() && !closes(source.lines[end])) ++end;
    if (end - i + 1 > 80)
      text += source.path + ":" + std::to_string(i + 1) + ": " + std::to_string(end - i + 1) + "\n";
  }
  return text;
}

std::string folder_of(const std::string& path, int depth) {
  std::size_t at = 0;
  for (int i = 0; i < depth; ++i) {
    const std::size_t next = path.find('/', at);
    if (next == std::string::npos) return path.substr(0, at == 0 ? 0 : at - 1);
    at = next + 1;
  }
  return path.substr(0, at - 1);
}

// "from -> to" for every pair of folders of `area` of which one includes the other.
std::set<std::string> arrows(const std::string& area) {
  std::set<std::string> found;
  for (const Source& source : sources()) {
    if (!source.path.starts_with(area + "/")) continue;
    const std::string from = folder_of(source.path, 2);
    for (const std::string& line : source.lines) {
      if (!line.starts_with("#include \"" + area + "/")) continue;
      const std::string to = folder_of(line.substr(10), 2);
      if (to != from) found.insert(from + " -> " + to);
    }
  }
  return found;
}

// Pairs of folders that include one another, however far around.
std::vector<std::string> circles(const std::string& area) {
  std::map<std::string, std::set<std::string>> reach;
  for (const std::string& arrow : arrows(area)) {
    const std::size_t at = arrow.find(" -> ");
    reach[arrow.substr(0, at)].insert(arrow.substr(at + 4));
  }
  for (std::size_t round = 0; round < reach.size(); ++round)
    for (auto& [from, targets] : reach)
      for (const std::string& via : std::set<std::string>(targets))
        if (const auto next = reach.find(via); next != reach.end())
          targets.insert(next->second.begin(), next->second.end());
  std::vector<std::string> found;
  for (const auto& [from, targets] : reach)
    if (targets.count(from)) found.push_back(from);
  return found;
}

std::string text_of(const std::vector<std::string>& folders) {
  std::string text;
  for (const auto& folder : folders) text += folder + " ";
  return text;
}

}  // namespace

TEST_CASE("no function is longer than 80 lines") {
  std::string text;
  for (const Source& source : sources()) text += long_functions(source);
  CHECK(text == "");
}

TEST_CASE("a source includes its own header first, so that each header is compiled as if alone") {
  std::set<std::string> headers;
  for (const Source& source : sources())
    if (source.path.ends_with(".hpp")) headers.insert(source.path);
  for (const Source& source : sources()) {
    if (!source.path.ends_with(".cpp")) continue;
    const std::string own = source.path.substr(0, source.path.size() - 3) + "hpp";
    if (!headers.count(own)) continue;
    const auto first = std::find_if(source.lines.begin(), source.lines.end(),
                                    [](const std::string& line) { return line.starts_with("#include"); });
    INFO(source.path);
    REQUIRE(first != source.lines.end());
    CHECK(*first == "#include \"" + own + "\"");
  }
}

TEST_CASE("no two folders include one another, however far around") {
  for (const char* area : {"core", "render", "app"}) CHECK(text_of(circles(area)) == "");
}

}  // namespace function_length_test
