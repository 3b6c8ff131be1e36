// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/nearest_name.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <random>
#include <string>

using namespace unfurl;

namespace nearest_name_test {

TEST_CASE("the nearest name is found by small slips") {
  const std::vector<std::string_view> known = {"post_length", "chord_rod_length", "density", "step"};
  CHECK(nearest_name("post_lenght", known) == "post_length");  // swapped
  CHECK(nearest_name("pos_length", known) == "post_length");   // left out
  CHECK(nearest_name("densitty", known) == "density");         // doubled
  CHECK(nearest_name("Density", known) == "density");          // case
  CHECK(nearest_name("stpe", known) == "step");
  CHECK(nearest_name("chord", known) == "chord_rod_length");  // beginning
}

TEST_CASE("what resembles nothing gets no suggestion but the list") {
  const std::vector<std::string_view> known = {"post_length", "density"};
  CHECK(nearest_name("gravity", known).empty());
  CHECK(nearest_name("", known).empty());
  // Three slips where a third of six letters are two: one put before, one changed, one behind.
  CHECK(nearest_name("abcdef", {"zabcdzfq"}).empty());
  CHECK(nearest_name("abcdef", {"zabcdefq"}) == "zabcdefq");
  CHECK(did_you_mean("gravity", known) == "; known: post_length, density");
  CHECK(did_you_mean("densty", known) == "; did you mean 'density'?");
  CHECK(did_you_mean("x", {}).empty());
}

TEST_CASE("a name in a message stays on its line") {
  CHECK(in_quotes("a\nb") == "'a\\x0ab'");
  CHECK(in_quotes(std::string(1000, 'x')).size() < 70);
}

namespace {

// The distance by its definition (Oommen and Loke's optimal string alignment), a recursion over what is left.
std::size_t slips(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const auto same = [](char x, char y) { return (x | 0x20) == (y | 0x20); };  // letters
  if (same(a[0], b[0])) return slips(a.substr(1), b.substr(1));
  std::size_t least =
      std::min({slips(a.substr(1), b), slips(a, b.substr(1)), slips(a.substr(1), b.substr(1))});
  if (a.size() > 1 && b.size() > 1 && same(a[0], b[1]) && same(a[1], b[0]))
    least = std::min(least, slips(a.substr(2), b.substr(2)));
  return least + 1;
}

// The first of the nearest: less than a third of the letters wrong (one at least may be), and not all of
// them.
std::string_view nearest_by_slips(std::string_view given, const std::vector<std::string_view>& known) {
  std::string_view best;
  std::size_t least = std::max<std::size_t>(1, given.size() / 3) + 1;
  for (const auto name : known) {
    const std::size_t n = slips(given, name);
    if (n >= least || n >= std::max(given.size(), name.size())) continue;
    least = n;
    best = name;
  }
  if (best.empty() && given.size() >= 3)
    for (const auto name : known)
      if (name.substr(0, given.size()) == given) return name;
  return best;
}

}  // namespace

TEST_CASE("the nearest name is that of the fewest slips, whatever the names") {
  std::mt19937 dice(20);
  const auto word = [&](std::size_t shortest, std::size_t longest) {
    std::string text(shortest + dice() % (longest - shortest + 1), ' ');
    for (char& c : text) c = "abcAB"[dice() % 5];
    return text;
  };
  int near = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const std::vector<std::string> names = {word(1, 8), word(1, 8), word(3, 8)};
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::string given = trial % 3 ? word(1, 7) : names[2].substr(0, 1 + dice() % names[2].size());
    const std::string_view expected = nearest_by_slips(given, known);
    near += !expected.empty();
    if (nearest_name(given, known) != expected)
      FAIL(given << " among " << names[0] << ", " << names[1] << ", " << names[2] << ": " << expected);
  }
  CHECK(near > 1000);
  CHECK(near < 3500);
}

TEST_CASE("a dozen known names are listed, of more there is no end") {
  std::vector<std::string_view> known = {"b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m"};
  const std::string dozen = "; known: b, c, d, e, f, g, h, i, j, k, l, m";
  CHECK(did_you_mean("zzzz", known) == dozen);
  known.push_back("n");
  CHECK(did_you_mean("zzzz", known) == dozen + ", ...");
  CHECK(did_you_mean("zzzz", known, "unfurl list letters") == dozen + ", ...; unfurl list letters tells all");
  // Who wrote eighty letters may have meant something, who wrote more has pasted something else.
  const std::string eighty(80, 'x'), name(79, 'x');
  CHECK(nearest_name(eighty, {name}) == name);
  CHECK(nearest_name(eighty + "x", {name}).empty());
  CHECK(nearest_name("ab", {"abcdefgh"}).empty());  // two letters begin too much
}

TEST_CASE("every byte has its place in quotes") {
  for (int byte = 0; byte < 256; ++byte) {
    const char c = static_cast<char>(byte);
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(byte));
    CHECK(in_quotes(std::string("p") + c + "q") ==
          (byte < 32 || byte == 127 ? std::string("'p") + code + "q'" : std::string("'p") + c + "q'"));
  }
  std::string name;
  for (int i = 0; i < 60; ++i) name += static_cast<char>('a' + i % 26);
  CHECK(in_quotes(name) == "'" + name + "'");
  CHECK(in_quotes(name + "z") == "'" + name + "...'");
}

TEST_CASE("a long name is cut between two characters") {
  // Characters of 1 to 4 bytes, so that byte 60 is at every place within one.
  for (const std::string character : {"e", "\xC3\xA9", "\xE6\x8A\x98", "\xF0\x9F\x93\x90"})
    for (std::size_t ahead = 50; ahead <= 61; ++ahead) {
      const std::string given = std::string(ahead, 'a') + character + std::string(20, 'b');
      const std::size_t n = character.size();
      // As many whole characters as have room in 60 bytes.
      const std::string kept = ahead >= 60       ? std::string(60, 'a')
                               : ahead + n <= 60 ? given.substr(0, 60)
                                                 : std::string(ahead, 'a');
      CHECK(in_quotes(given) == "'" + kept + "...'");
    }
  // What is no UTF-8 is cut at the byte.
  CHECK(in_quotes(std::string(80, '\xA9')) == "'" + std::string(60, '\xA9') + "...'");
  CHECK(in_quotes(std::string(59, 'a') + "\xC3z") == "'" + std::string(59, 'a') + "\xC3...'");
}

TEST_CASE("a known name with a unit behind it is told from other names") {
  const std::vector<std::string_view> known = {"mass", "mass_per_length", "step", "a", "area"};
  const auto before = [&](std::string_view given) { return std::string(name_before_unit(given, known)); };
  for (const char* given : {"mass_kg", "mass kg", "mass_KG", "mass(kg)", "mass (kg)", "mass[kg]", "mass_[kg]",
                            "mass kg/m", "mass_kg_m2", "mass_g", "mass_t", "mass \u00B5m"})
    CHECK(before(given) == "mass");
  CHECK(before("mass_per_length_kg_per_m") == "mass_per_length");
  CHECK(before("step_ms") == "step");
  CHECK(before("area_mm^2") == "area");
  CHECK(before("area_V") == "area");
  CHECK(before("area_A") == "area");
  for (const char* given : {"masskg", "mass_rate", "mass_", "mass ", "mass", "area_a", "area_v", "mass-kg",
                            "length_mm", "mass_kgs", "mass_mk", "kg"})
    CHECK(before(given).empty());
  CHECK(name_before_unit("mass_g", {"mass", "mass_m"}).empty());  // nearer to another name
}

}  // namespace nearest_name_test
