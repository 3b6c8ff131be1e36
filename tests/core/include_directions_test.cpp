// SPDX-License-Identifier: BSD-3-Clause
// The house keeps its directions: app -> render -> core, and a library with one door has one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace include_directions_test {

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // path from the root
  std::string target;  // what is between the quotes or brackets
};

bool is_source(const fs::path& path) {
  return path.extension() == ".cpp" || path.extension() == ".hpp";
}

std::vector<Include> includes_of(const std::string& folder) {
  std::vector<Include> found;
  const fs::path root = UNFURL_ROOT;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (!is_source(entry.path())) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with("#include ")) continue;
      const std::size_t begin = line.find_first_of("\"<") + 1, end = line.find_first_of("\">", begin);
      found.push_back({fs::relative(entry.path(), root).string(), line.substr(begin, end - begin)});
    }
  }
  return found;
}

std::vector<Include> all_includes() {
  std::vector<Include> found;
  for (const char* folder : {"core", "render", "app"})
    for (auto& include : includes_of(folder)) found.push_back(std::move(include));
  return found;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const auto& prefix : prefixes)
    if (text.starts_with(prefix)) return true;
  return false;
}

// Files in `folder` that include something they must not.
std::string offenders(const std::string& folder, const std::vector<std::string>& forbidden) {
  std::string text;
  for (const auto& include : includes_of(folder))
    if (starts_with_any(include.target, forbidden))
      text += include.file + " includes " + include.target + "\n";
  return text;
}

// Files that include a header whose name begins so, other than those under the allowed paths.
std::string elsewhere(const std::vector<std::string>& headers, const std::vector<std::string>& allowed) {
  std::string text;
  for (const auto& include : all_includes())
    if (starts_with_any(include.target, headers) && !starts_with_any(include.file, allowed))
      text += include.file + " includes " + include.target + "\n";
  return text;
}

// How many .cpp files include the header.
std::size_t doors(const std::vector<std::string>& headers) {
  std::vector<std::string> files;
  for (const auto& include : all_includes())
    if (starts_with_any(include.target, headers) &&
        std::find(files.begin(), files.end(), include.file) == files.end())
      files.push_back(include.file);
  return files.size();
}

}  // namespace

TEST_CASE("the scan sees the sources") {
  CHECK(all_includes().size() > 200);
}

TEST_CASE("core knows neither render nor app, render not app") {
  CHECK(offenders("core", {"render/", "app/", "tests/"}) == "");
  CHECK(offenders("render", {"app/", "tests/"}) == "");
  CHECK(offenders("app", {"tests/"}) == "");
}

TEST_CASE("core draws nothing and prints nothing") {
  CHECK(offenders("core", {"GL/", "GLES", "EGL/", "SDL", "imgui", "iostream", "print"}) == "");
}

TEST_CASE("each room of core knows only those before it") {
  const std::vector<std::string> rooms = {"text",   "math",       "structure",   "constraints", "forces",
                                          "system", "structures", "integrators", "simulate",    "diagnostics",
                                          "path",   "scene",      "export",      "study"};
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    std::vector<std::string> later;
    for (std::size_t k = i + 1; k < rooms.size(); ++k) later.push_back("core/" + rooms[k] + "/");
    CHECK(offenders("core/" + rooms[i], later) == "");
  }
  CHECK(offenders("core/math", {"core/text/"}) == "");
}

TEST_CASE("render never calls a solver") {
  for (const auto& include : includes_of("render")) {
    const bool solver = include.target.starts_with("core/integrators/") &&
                        include.target != "core/integrators/solver_options.hpp";
    CHECK_FALSE(solver);
  }
  CHECK(offenders("render", {"core/constraints/", "core/forces/", "core/structures/", "core/math/saddle"}) ==
        "");
}

TEST_CASE("libraries with one door have one") {
  CHECK(elsewhere({"toml++", "toml.hpp"}, {"core/scene/toml_parse.cpp"}) == "");
  CHECK(doors({"toml++"}) == 1);
  CHECK(elsewhere({"CLI/"}, {"app/cli.cpp"}) == "");
  CHECK(doors({"CLI/"}) == 1);
  CHECK(doors({"stb/", "stb_"}) <= 1);
  CHECK(elsewhere({"GL/", "EGL/"}, {"render/gl/", "render/scene/renderer", "render/ui/", "app/window"}) ==
        "");
  CHECK(elsewhere({"imgui"}, {"render/ui/", "app/panel"}) == "");
}

}  // namespace include_directions_test
