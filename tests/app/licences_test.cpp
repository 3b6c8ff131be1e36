// SPDX-License-Identifier: BSD-3-Clause
// The licence, and docs/licences.md: under what licence every library is that the program links.
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "tests/app/run_program.hpp"

namespace licences_test {

// The shared libraries of the program, as the dynamic linker finds them: "libz" of "libz.so.1 => ...".
std::vector<std::string> linked_libraries() {
  const std::string command = std::string("ldd '") + UNFURL_PROGRAM + "'";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::vector<std::string> names;
  std::array<char, 4096> line{};
  while (pipe && fgets(line.data(), line.size(), pipe.get())) {
    const std::string text = line.data();
    const std::size_t begin = text.find_first_not_of(" \t"), end = text.find(".so");
    if (text.find(" => ") != std::string::npos && end != std::string::npos)
      names.push_back(text.substr(begin, end - begin));
  }
  return names;
}

bool of_a_sanitizer(const std::string& name) {
  return name.ends_with("san");
}

TEST_CASE("the licence is BSD-3-Clause") {
  CHECK(unfurl::file_text(UNFURL_ROOT "/LICENSE").starts_with("BSD 3-Clause License\n"));
}

// A user who only solves does not wait for what draws.
TEST_CASE("what only some verbs need is not loaded at the start") {
  for (const std::string& name : linked_libraries())
    for (const char* late :
         {"libSDL", "libOSMesa", "libGL", "libEGL", "libLLVM", "libX11", "libpython", "libav"})
      CHECK_FALSE(name.starts_with(late));
}

TEST_CASE("docs/licences.md names every library that the program links") {
  const std::string page = unfurl::file_text(UNFURL_ROOT "/docs/licences.md");
  const auto names = linked_libraries();
  CHECK(names.size() > 5);
  for (const auto& name : names) {
    INFO(name);
    if (!of_a_sanitizer(name)) CHECK(page.find(name) != std::string::npos);
  }
}

TEST_CASE("nothing of Eigen that is under the LGPL is included") {
  int files = 0;
  for (const char* folder : {"/core", "/render", "/app"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(UNFURL_ROOT + std::string(folder))) {
      if (!entry.is_regular_file()) continue;
      INFO(entry.path().string());
      CHECK(unfurl::file_text(entry.path().string()).find("<unsupported/Eigen") == std::string::npos);
      ++files;
    }
  CHECK(files > 300);
}

}  // namespace licences_test
