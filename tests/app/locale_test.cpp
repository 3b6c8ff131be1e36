// SPDX-License-Identifier: BSD-3-Clause
// Numbers are the same in every country: the decimal point of the environment is not that of files.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "tests/app/run_program.hpp"
#include "tests/support/not_tested.hpp"

namespace unfurl::locale_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

// What the verbs print and write. Into one directory, whose name is in receipts; the summary holds CPU times.
std::map<std::string, std::string> results(const std::string& out, const Words& environment) {
  fs::remove_all(out);
  const ProgramOptions options{.environment = environment};
  const std::string end = "solver.end_time=0.25";
  std::map<std::string, std::string> all;
  for (const Words& words :
       {Words{"check", "hoop6"}, Words{"check", "scissor_mast", "--json"}, Words{"list", "keys", "solver"},
        Words{"show", "hoop6", "--set", "structure.fold_angle=80.5"},
        Words{"run", "hoop6_motor", "--set", end, "--export", "csv,vtk,gltf", "-o", out + "/run"},
        Words{"figure", "hoop6", "energy", "--set", end, "-o", out + "/energy.svg"},
        Words{"figure", "hoop6", "energy", "--set", end, "-o", out + "/energy.pdf"},
        Words{"sweep", "pendulum", "--set", end, "--vary", "solver.step=0.05:0.1:2", "--measure", "energy",
              "-o", out + "/sweep"}}) {
    fs::create_directories(out);
    const ProgramResult r = run_program(words, options);
    INFO(r.err);
    REQUIRE(r.code == 0);
    all[words[0] + " " + words[1]] = r.out;
  }
  for (const auto& entry : fs::recursive_directory_iterator(out))
    if (entry.is_regular_file() && entry.path().filename() != "summary.json" &&
        entry.path().filename() != ".unfurl")
      all[entry.path().lexically_relative(out).string()] = file_text(entry.path().string());
  return all;
}

}  // namespace

TEST_CASE("where the comma is the decimal point every byte is the same") {
  const ScratchDirectory dir;
  fs::create_directories(dir / "locales");
  const std::string made = "localedef -i de_DE -f UTF-8 --no-archive '" + dir / "locales/de_DE.UTF-8" +
                           "' > '" + dir / "log" + "' 2>&1";
  if (testing::lacks(std::system(made.c_str()) == 0, "a foreign locale (apt-get install locales)")) return;
  const std::string folder = "LOCPATH=" + dir / "locales", language = "LC_ALL=de_DE.UTF-8";
  // The locale is one: else the test would say nothing.
  REQUIRE(std::system(("test \"$(env " + folder + " " + language + " locale decimal_point)\" = ,").c_str()) ==
          0);
  const auto german = results(dir / "out", {folder, language, "LANG=de_DE.UTF-8"}),
             plain = results(dir / "out", {"LC_ALL=C"});
  REQUIRE(german.size() == plain.size());
  CHECK(plain.size() > 15);
  for (const auto& [name, text] : plain) {
    INFO(name);
    REQUIRE(german.contains(name));
    CHECK(german.at(name) == text);
  }
}

}  // namespace unfurl::locale_test
