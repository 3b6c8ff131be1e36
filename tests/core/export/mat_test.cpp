// SPDX-License-Identifier: BSD-3-Clause
// A MAT-file, read back with nothing but its specification (tests/support/check_exports.py has it read by
// Octave).
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
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

namespace {

struct Numbers {
  std::vector<std::int32_t> shape;
  std::uint32_t kind = 0;  // 6: reals, 9 and 0x200: true or false
  std::vector<double> values;
};

// Every array of numbers by its name, as it lies: column by column.
std::map<std::string, Numbers> numbers_in(const std::string& file) {
  std::map<std::string, Numbers> out;
  for (const Element& array : elements(file, 128)) {
    CHECK(array.type == 14);
    const std::vector<Element> parts = elements(array.data);  // flags, shape, name, contents
    if ((word(parts[0].data, 0) & 0xFFU) == 1) continue;      // cells
    CHECK((parts[0].type == 6 && parts[1].type == 5 && parts[2].type == 1));
    Numbers& found = out[parts[2].data];
    found.kind = word(parts[0].data, 0);
    for (std::size_t k = 0; k < parts[1].data.size(); k += 4)
      found.shape.push_back(static_cast<std::int32_t>(word(parts[1].data, k)));
    REQUIRE(parts.size() == 4);
    if (parts[3].type == 9) {
      found.values.resize(parts[3].data.size() / sizeof(double));
      std::memcpy(found.values.data(), parts[3].data.data(), parts[3].data.size());
    } else {
      CHECK(parts[3].type == 2);
      for (const char c : parts[3].data) found.values.push_back(c);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("numbers in a MAT-file are those of the run column by column") {
  const Simulation run = testing::run_scene(
      "[structure]\nkind = 'hoop'\nmodel = 'sector'\nunits = 4\n[solver]\nstep = 0.02\nend_time = 0.1\n");
  const Diagnostics d = diagnose(run);
  const fs::path folder = fs::temp_directory_path() / ("unfurl_mat_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  find_export_format("mat")->write({run, d, folder, "numbers", 0.1, 1.0});
  std::ostringstream file;
  file << std::ifstream(folder / "run.mat", std::ios::binary).rdbuf();
  fs::remove_all(folder);
  CHECK(file.str().starts_with("MATLAB 5.0 MAT-file"));  // by which readers know it
  CHECK(file.str().substr(124, 4) == std::string("\x00\x01IM", 4));
  const auto found = numbers_in(file.str());
  const Structure& structure = run.trajectory.structure();
  const auto &time = found.at("t_s"), &x = found.at("positions_m"), &v = found.at("velocities_m_s"),
             &force = found.at("axial_forces_N"), &unique = found.at("axial_forces_unique"),
             &ends = found.at("rod_nodes"), &series = found.at("series");
  const std::size_t steps = run.trajectory.size(), nodes = structure.node_copies.size(),
                    rods = structure.rod_copies.size(), columns = d.columns.size();
  const auto shape = [](std::initializer_list<std::size_t> sizes) {
    return std::vector<std::int32_t>(sizes.begin(), sizes.end());
  };
  CHECK(time.shape == shape({steps, 1}));
  for (const Numbers* array : {&x, &v}) CHECK(array->shape == shape({steps, nodes, 3}));
  for (const Numbers* array : {&force, &unique}) CHECK(array->shape == shape({steps, rods}));
  CHECK(ends.shape == shape({rods, 2}));
  CHECK(series.shape == shape({steps, columns}));
  for (const auto& [name, array] : found) {
    INFO(name);
    CHECK(array.kind == (name == "axial_forces_unique" ? 0x209U : 6U));
    std::size_t size = 1;
    for (const std::int32_t n : array.shape) size *= static_cast<std::size_t>(n);
    REQUIRE(array.values.size() == size);
  }
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t i = 0; i < steps; ++i) {
    CHECK(time.values[i] == run.trajectory.time(i));
    const VectorXd q = run.trajectory.positions(i), w = run.trajectory.velocities(i);
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = i + steps * (n + nodes * k);
        CHECK(x.values[at] == q[static_cast<Index>(3 * n + k)]);
        CHECK(v.values[at] == w[static_cast<Index>(3 * n + k)]);
      }
    for (std::size_t r = 0; r < rods; ++r) {
      const int source = structure.rod_copies[r].source;
      CHECK(same(force.values[i + steps * r], d.axial_force(static_cast<Index>(i), source)));
      CHECK(unique.values[i + steps * r] == (d.force_unique(static_cast<Index>(i), source) ? 1 : 0));
    }
    for (std::size_t c = 0; c < columns; ++c)
      CHECK(same(series.values[i + steps * c], d.columns[c].values[i]));
  }
  for (std::size_t r = 0; r < rods; ++r) {
    CHECK(ends.values[r] == structure.rod_copies[r].a + 1);
    CHECK(ends.values[rods + r] == structure.rod_copies[r].b + 1);
  }
}

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
