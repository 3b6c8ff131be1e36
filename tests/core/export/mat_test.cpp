// SPDX-License-Identifier: BSD-3-Clause
// Names in a MAT-file, read back with nothing but its specification (tests/support/check_exports.py has the
// numbers read by Octave).
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/export/formats.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace mat_test {

namespace {

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t x = 0;
  std::memcpy(&x, bytes.data() + at, sizeof x);
  return x;
}

struct Element {
  std::uint32_t type;
  std::string data;
};

// All data elements of a text: tag, data, padding to eight bytes.
std::vector<Element> elements(const std::string& bytes, std::size_t at = 0) {
  std::vector<Element> out;
  while (at < bytes.size()) {
    const std::size_t size = word(bytes, at + 4);
    out.push_back({word(bytes, at), bytes.substr(at + 8, size)});
    at += 8 + (size + 7) / 8 * 8;
  }
  return out;
}

// The cells of each array of cells: rows of characters in UTF-16.
std::map<std::string, std::vector<std::u16string>> names_in(const std::string& file) {
  std::map<std::string, std::vector<std::u16string>> out;
  for (const Element& array : elements(file, 128)) {
    const std::vector<Element> parts = elements(array.data);  // flags, shape, name, contents
    if ((word(parts[0].data, 0) & 0xFFU) != 1) continue;      // no cells
    for (std::size_t k = 3; k < parts.size(); ++k) {
      const std::vector<Element> cell = elements(parts[k].data);
      CHECK(word(cell[0].data, 0) == 4);  // characters
      REQUIRE(cell[3].type == 4);         // two bytes each
      std::u16string text(cell[3].data.size() / 2, u' ');
      std::memcpy(text.data(), cell[3].data.data(), cell[3].data.size());
      CHECK(word(cell[1].data, 0) == 1);
      CHECK(word(cell[1].data, 4) == text.size());
      out[parts[2].data].push_back(text);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("names in a MAT-file are what the scene calls them, in whatever letters") {
  const Simulation run = testing::run_scene(R"(
[structure]
kind = "custom"
[[structure.nodes]]
name = "Fu\u00DF \u00C4"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "\u4E2D \U00012345"
position = [1.2, 0, 0]
mass = 2
[[structure.rods]]
name = "Tr\u00E4ger"
nodes = ["Fu\u00DF \u00C4", "\u4E2D \U00012345"]
mass = 1
[solver]
step = 0.05
end_time = 0.1
)");
  const Diagnostics d = diagnose(run);
  const fs::path folder = fs::temp_directory_path() / ("unfurl_mat_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  find_export_format("mat")->write({run, d, folder, "names", 0.1, 1.0});
  std::ostringstream file;
  file << std::ifstream(folder / "run.mat", std::ios::binary).rdbuf();
  fs::remove_all(folder);
  const auto names = names_in(file.str());
  CHECK(names.at("node_names") == std::vector<std::u16string>{u"Fu\u00DF \u00C4", u"\u4E2D \U00012345"});
  CHECK(names.at("rod_names") == std::vector<std::u16string>{u"Tr\u00E4ger"});
  CHECK(std::ranges::count(names.at("series_names"), u"Fu\u00DF \u00C4.reaction_N") == 1);
}

}  // namespace mat_test
