// SPDX-License-Identifier: BSD-3-Clause
// Scenes with bytes changed, cut and spliced must give a scene or an error with a place, never anything else.
#include <catch2/catch.hpp>
#include <random>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"

using namespace unfurl;

namespace fuzz_test {

namespace {

const std::vector<std::string>& morsels() {
  static const std::vector<std::string> list = {"[",
                                                "]",
                                                "[[",
                                                "]]",
                                                "{",
                                                "}",
                                                "=",
                                                ",",
                                                ".",
                                                "\"",
                                                "'",
                                                "\"\"\"",
                                                "'''",
                                                "#",
                                                "\n",
                                                "\r\n",
                                                "\\",
                                                "\\u",
                                                "\\U0010FFFF",
                                                "\\ud800",
                                                "[$",
                                                "\xEF\xBB\x9F",
                                                "\xEF\xBB\xBF",
                                                "\xFF\xFE",
                                                "\xC3",
                                                std::string(1, '\0'),
                                                "nan",
                                                "-inf",
                                                "1e999",
                                                "99999999999999999999",
                                                "0x",
                                                "0b2",
                                                "1979-05-27T07:32:00Z",
                                                "25:61",
                                                "true",
                                                "[[[[[[[[[[[[",
                                                "a.b.c.d.e.f=1\n",
                                                "[structure]\n",
                                                "[[structure.nodes]]\n",
                                                "\xE2\x80\xA8",
                                                "+",
                                                "-",
                                                "_",
                                                "1_",
                                                "\t",
                                                "\x7f"};
  return list;
}

std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = below(text.size() + 1);
    switch (below(5)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.insert(at, morsels()[below(morsels().size())]);
        break;
      case 2:
        text.erase(at, below(40) + 1);
        break;
      case 3:
        text.resize(at);
        break;
      default:
        text.insert(at, text.substr(below(text.size() + 1), below(60)));
    }
    if (text.empty()) text = "x";
  }
  return text;
}

}  // namespace

TEST_CASE("mutated scenes give a scene or located errors") {
  std::mt19937 random(20240601);
  int read = 0, refused = 0;
  for (const auto& row : library_scenes()) {
    const std::string text = read_text_file(row.path).text;
    for (int i = 0; i < 1500; ++i) {
      const std::string scene = mutated(text, random);
      try {
        read_scene_text(scene, "s.toml");
        ++read;
      } catch (const SceneError& error) {
        ++refused;
        REQUIRE_FALSE(error.problems().empty());
        for (const auto& problem : error.problems()) {
          REQUIRE(problem.where.line > 0);
          REQUIRE_FALSE(problem.message.empty());
        }
      }
    }
  }
  // Both outcomes are exercised: changes in comments and digits are harmless, most others are not.
  CHECK(read > 500);
  CHECK(refused > 500);
}

TEST_CASE("mutated overrides give a scene or errors") {
  // Short: it is read 3000 times.
  const std::string scene =
      "structure = {kind = 'custom', nodes = [{name = 'A', position = [1, 0, 0], mass = 2}]}";
  std::mt19937 random(7);
  int read = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string override_ = mutated("structure.nodes[0].position=[0, 1, 2]", random);
    try {
      read_scene_text(scene, "s.toml", {override_});
      ++read;
    } catch (const SceneError& error) {
      ++refused;
      REQUIRE_FALSE(error.problems().empty());
    }
  }
  // Both outcomes are exercised: a changed digit moves the node, most other changes make no override.
  CHECK(read > 10);
  CHECK(refused > 500);
}

}  // namespace fuzz_test
